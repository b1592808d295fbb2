#include "core/beyond/tracked_surface/tool_positions.h"

#include <gtest/gtest.h>

#include "core/dissertation/tool/shape/generated_tools.h"
#include "tests/support/box_tool.h"

namespace remote_touch::tool_positions_test {
namespace {

constexpr double kRadius_m = 0.0325;

TEST(ToolPositions, APlateIsOneGroupAndABarTwo) {
  EXPECT_EQ(ToolPositions(box_mesh({0.04, 0.01, 0.04}), kRadius_m, 4).groups().size(), 1);
  EXPECT_EQ(ToolPositions(box_mesh({0.08, 0.02, 0.01}), kRadius_m, 4).groups().size(), 2);
  EXPECT_EQ(ToolPositions(box_mesh({0.08, 0.02, 0.01}), kRadius_m, 1).groups().size(), 1);
}

TEST(ToolPositions, TheyLieOnTheSurfaceAndCoverIt) {
  const Vec3 half_m(0.02, 0.005, 0.02);
  const TriangleMesh mesh = box_mesh(2 * half_m);
  const ToolPositions positions(mesh, kRadius_m, 4);
  ASSERT_LE(positions.all().size(), ToolPositions::kMax);
  for (const Vec3& p : positions.all()) EXPECT_NEAR(scenes::box_distance(half_m, p), 0, 1e-12);
  const auto distance_m = [&](const Vec3& from) {
    double nearest = 1;
    for (const Vec3& p : positions.all()) nearest = std::min(nearest, (p - from).norm());
    return nearest;
  };
  for (const Vec3& corner : mesh.vertices) EXPECT_LT(distance_m(corner), 0.3 * kRadius_m);
  for (double x = -0.02; x <= 0.02; x += 0.001)
    for (double z = -0.02; z <= 0.02; z += 0.001) EXPECT_LT(distance_m({x, -0.005, z}), 0.3 * kRadius_m);
}

TEST(ToolPositions, EachIsWithinTheRadiusOfItsGroup) {
  for (const GeneratedTool& tool : generated_tools()) {
    const ToolPositions positions(tool.make(), kRadius_m, 16);
    std::size_t count = 0;
    for (const ToolPositions::Group& group : positions.groups()) {
      EXPECT_LE(group.radius_m, kRadius_m) << tool.name;
      EXPECT_EQ(group.first, count) << tool.name;
      for (const Vec3& p : positions.of(group))
        EXPECT_LE((p - group.middle_T).norm(), group.radius_m) << tool.name;
      count += group.count;
    }
    EXPECT_EQ(count, positions.all().size()) << tool.name;
  }
}

}  // namespace
}  // namespace remote_touch::tool_positions_test
