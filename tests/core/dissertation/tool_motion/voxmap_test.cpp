// The voxmap compared with a set of all voxels that hold a point.
#include "core/dissertation/tool_motion/voxmap.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "tests/support/scenes.h"

namespace remote_touch::voxmap_test {
namespace {

TEST(Voxmap, HasTheVoxelsThatHoldAPoint) {
  constexpr double voxel_m = 0.003;
  const PointCloud cloud = scenes::random_cloud(3000, 0.05, 3);
  std::set<std::array<double, 3>> held;
  const auto voxel = [&](const Vec3& p) {
    return std::array{std::floor(p.x() / voxel_m), std::floor(p.y() / voxel_m), std::floor(p.z() / voxel_m)};
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) held.insert(voxel(cloud.point(i)));
  const Voxmap map(cloud, voxel_m);
  const PointCloud places = scenes::random_cloud(20000, 0.06, 4);
  int surface = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::array at = voxel(places.point(i));
    const std::optional<Vec3> middle = map.surface_middle_W(places.point(i));
    ASSERT_EQ(middle.has_value(), held.count(at) == 1);
    if (!middle) continue;
    ++surface;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR((*middle)[axis], voxel_m * (at[static_cast<std::size_t>(axis)] + 0.5), 1e-15);
  }
  EXPECT_GT(surface, 500);
}

TEST(Voxmap, AllIsFreeIfThereAreNoUsablePoints) {
  PointCloud cloud;
  EXPECT_FALSE(Voxmap(cloud, 0.003).surface_middle_W(Vec3::Zero()));
  cloud.append(Vec3::Constant(std::nan("")));
  cloud.append({1e9, 0, 0});
  const Voxmap map(cloud, 0.003);
  EXPECT_FALSE(map.surface_middle_W(Vec3::Zero()));
  EXPECT_FALSE(map.surface_middle_W({1e9, 0, 0}));
  EXPECT_FALSE(map.surface_middle_W(Vec3::Constant(std::nan(""))));
}

}  // namespace
}  // namespace remote_touch::voxmap_test
