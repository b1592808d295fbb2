// The x86-64 levels of the kernels that the running machine supports. All levels compute the same bits.
#pragma once

#include <span>

#include "core/kernels/kernels.h"

namespace remote_touch {

// x86-64 levels in rising order.
enum class Isa { x86_64, x86_64_v3, x86_64_v4 };

Isa best_isa();                   // the highest level of the running machine
const Kernels& kernels_for(Isa);  // pre: the machine has that level
// Kernels of every level that the running machine supports, in rising order.
std::span<const Kernels* const> supported_kernels();

}  // namespace remote_touch
