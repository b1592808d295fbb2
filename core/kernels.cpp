#include "core/kernels.h"

#include "core/kernels/level.h"

REMOTE_TOUCH_DECLARE_KERNELS(x86_64)
REMOTE_TOUCH_DECLARE_KERNELS(x86_64_v3)
REMOTE_TOUCH_DECLARE_KERNELS(x86_64_v4)

namespace remote_touch {

namespace {
constexpr Kernels kX86_64{"x86-64",        x86_64::append_within, x86_64::survey,    x86_64::first_hit,
                          x86_64::way_out, x86_64::normals,       x86_64::candidates};
constexpr Kernels kX86_64v3{"x86-64-v3",          x86_64_v3::append_within, x86_64_v3::survey,
                            x86_64_v3::first_hit, x86_64_v3::way_out,       x86_64_v3::normals,
                            x86_64_v3::candidates};
constexpr Kernels kX86_64v4{"x86-64-v4",          x86_64_v4::append_within, x86_64_v4::survey,
                            x86_64_v4::first_hit, x86_64_v4::way_out,       x86_64_v4::normals,
                            x86_64_v4::candidates};
}  // namespace

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
      return kX86_64v4;
    case Isa::x86_64_v3:
      return kX86_64v3;
    case Isa::x86_64:
      break;
  }
  return kX86_64;
}

}  // namespace remote_touch
