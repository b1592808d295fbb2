// The kernels of every instruction set level that this machine has, the slowest first.
#pragma once

#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch {

inline std::vector<const Kernels*> every_level() {
  std::vector<const Kernels*> levels;
  for (const Isa isa : {Isa::x86_64, Isa::x86_64_v3, Isa::x86_64_v4})
    if (isa <= best_isa()) levels.push_back(&kernels_for(isa));
  return levels;
}

}  // namespace remote_touch
