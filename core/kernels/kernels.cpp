#include "core/kernels/kernels.h"

#include "core/kernels/level.h"

REMOTE_TOUCH_DECLARE_KERNELS(x86_64)
REMOTE_TOUCH_DECLARE_KERNELS(x86_64_v3)
REMOTE_TOUCH_DECLARE_KERNELS(x86_64_v4)

namespace remote_touch {

namespace {
// In the order of the struct.
#define REMOTE_TOUCH_KERNELS(isa, level)                                                                     \
  {                                                                                                          \
    isa, level::append_within, level::contact_query, level::first_hit, level::exit_distance, level::normals, \
        level::candidates, level::near_spheres, level::points_in_cells, level::disks_in_field,               \
        level::append_near_regions, level::deepest_region, level::next_deepest_region,                       \
        level::points_of_patch, level::heights_above, level::sums_near_plane, level::height_bins,            \
        level::sums_of_quadratic, level::depth_to_points, level::filter_depth, level::plane_normals,         \
        level::points_to_cloud, level::normals_to_cloud                                                      \
  }

constexpr Kernels kX86_64 = REMOTE_TOUCH_KERNELS("x86-64", x86_64);
constexpr Kernels kX86_64v3 = REMOTE_TOUCH_KERNELS("x86-64-v3", x86_64_v3);
constexpr Kernels kX86_64v4 = REMOTE_TOUCH_KERNELS("x86-64-v4", x86_64_v4);
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
