// The levels of the kernels that the running machine has. A program may take kernels_for(best_isa()); which
// one is the fastest is for a measurement to tell (runners/kernel_choice). All give the same bits.
#pragma once

#include <span>

#include "core/kernels/kernels.h"

namespace remote_touch {

// x86-64 levels in rising order.
enum class Isa { x86_64, x86_64_v3, x86_64_v4 };

Isa best_isa();                   // the highest of the running machine
const Kernels& kernels_for(Isa);  // pre: the machine has that level
// Those of every level that the running machine has, in rising order.
std::span<const Kernels* const> supported_kernels();

}  // namespace remote_touch
