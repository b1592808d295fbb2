// The choice of the kernels' x86-64 level, made once, where a program starts.
#pragma once

#include <span>

#include "core/kernels/kernels.h"

namespace remote_touch {

// x86-64 levels in rising order.
enum class Isa { x86_64, x86_64_v3, x86_64_v4 };

Isa best_isa();                   // of the running machine
const Kernels& kernels_for(Isa);  // pre: the machine has that level
// Those of every level that the running machine has, in rising order.
std::span<const Kernels* const> supported_kernels();

}  // namespace remote_touch
