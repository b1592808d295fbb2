#include "core/kernels.h"

namespace remote_touch {

extern const Kernels kernels_x86_64;
extern const Kernels kernels_x86_64_v3;
extern const Kernels kernels_x86_64_v4;

Isa best_isa() {
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? Isa::x86_64_v4 : v3 ? Isa::x86_64_v3 : Isa::x86_64;
}

const Kernels& kernels_for(Isa isa) {
  switch (isa) {
    case Isa::x86_64_v4:
      return kernels_x86_64_v4;
    case Isa::x86_64_v3:
      return kernels_x86_64_v3;
    case Isa::x86_64:
      break;
  }
  return kernels_x86_64;
}

}  // namespace remote_touch
