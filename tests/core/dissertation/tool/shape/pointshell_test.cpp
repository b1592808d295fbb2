// The pointshell of a box, for which the result is known.
#include "core/dissertation/tool/shape/pointshell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/box_tool.h"

namespace remote_touch::pointshell_test {
namespace {

// Number of cubes that hold voxels of the shell of a box around the origin: all cubes with voxels of the box,
// less those without an outermost voxel. The latter are all but the first and the last along each axis.
std::size_t shell_cubes(const Vec3& half_m, double voxel_m, double spacing_m) {
  double all = 1, inner = 1;
  for (const double half : half_m) {
    const double cubes = 2 * (std::floor((half - 0.5 * voxel_m) / spacing_m) + 1);
    all *= cubes, inner *= cubes - 2;
  }
  return static_cast<std::size_t>(all - inner);
}

TEST(Pointshell, LiesOnTheFacesOfABoxWithNormalsIntoIt) {
  const Vec3 half_m(0.02, 0.005, 0.01);
  constexpr double kVoxel_m = 5e-4;
  const auto tool = scenes::box_tool(half_m, kVoxel_m);
  for (const double spacing_m : {0.002, 0.003}) {
    const Pointshell shell = make_pointshell(*tool, spacing_m);
    EXPECT_EQ(shell.size(), shell_cubes(half_m, kVoxel_m, spacing_m)) << spacing_m;
    for (std::size_t i = 0; i < shell.size(); ++i) {
      EXPECT_NEAR(scenes::box_distance(half_m, shell.p_T[i]), 0, 3e-4);
      EXPECT_NEAR(shell.n_T[i].norm(), 1, 1e-12);
      EXPECT_LT(scenes::box_distance(half_m, shell.p_T[i] + 1e-3 * shell.n_T[i]), -3e-4);
    }
  }
}

// No position of the lower face is far from a point.
TEST(Pointshell, HasNoHoles) {
  const Vec3 half_m(0.02, 0.005, 0.01);
  constexpr double spacing_m = 0.003;
  const Pointshell shell = make_pointshell(*scenes::box_tool(half_m), spacing_m);
  for (double x = -0.02; x <= 0.02; x += 0.0007)
    for (double z = -0.01; z <= 0.01; z += 0.0007) {
      double nearest = 1;
      for (const Vec3& p : shell.p_T) nearest = std::min(nearest, (p - Vec3(x, -half_m.y(), z)).norm());
      EXPECT_LT(nearest, 1.5 * spacing_m);
    }
}

}  // namespace
}  // namespace remote_touch::pointshell_test
