// The penalty rule compared with the balance of its springs in closed form.
#include "core/dissertation/tool_motion/penalty_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/points/vector.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::penalty_motion_test {
namespace {

const Vec3 kHalf_m(0.02, 0.005, 0.01);

ToolRenderer renderer(const ToolPenaltyParameters& p = {}) {
  const auto tool = scenes::box_tool(kHalf_m);
  return {tool_parameters(p), tool, scenes::kernels(), make_penalty_motion(p, *tool)};
}

// columns x rows points at y = 0, 2 mm apart. No point is nearer than 1 mm to an edge of the tool.
PointCloud sheet(int columns, int rows, double x_m = 0) {
  PointCloud cloud;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      cloud.append({x_m + (i - 0.5 * (columns - 1)) * 0.002, 0, (j - 0.5 * (rows - 1)) * 0.002},
                   Vec3::UnitY());
  return cloud;
}

// Output after 49 ticks with the device at a pose whose lower side is at this height.
RenderOutput pressed(const PointCloud& cloud, double lower_side_m, const ToolPenaltyParameters& p = {}) {
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(cloud));
  const auto at = [](double y) {
    return DeviceState{{0, kHalf_m.y() + y, 0}, Eigen::Quaterniond::Identity()};
  };
  r.step(at(0.001), 0);
  RenderOutput out;
  for (int i = 1; i < 50; ++i) out = r.step(at(lower_side_m), 0.001 * i);
  return out;
}

TEST(PenaltyMotion, ToolIsTheDeviceInFreeSpace) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet(40, 40)));
  expect_free(r);
}

// Balance of the springs at the depth s: k (D - s) = min(N, 10) k_p s for N points and the device's depth D.
TEST(PenaltyMotion, SinksUntilTheSpringsBalance) {
  constexpr double k = 600, k_p = 2400, pressed_m = 0.004;
  for (const auto& [columns, rows, pushing] : {std::tuple{20, 10, 10}, {5, 2, 10}, {3, 2, 6}}) {
    const RenderOutput out = pressed(sheet(columns, rows), -pressed_m);
    const double sinks_m = k * pressed_m / (k + pushing * k_p);
    EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y() - sinks_m, 1e-6) << columns;
    EXPECT_NEAR(out.force_N.y(), k * (pressed_m - sinks_m), 1e-3) << columns;
    EXPECT_EQ(out.tool->active_constraints, columns * rows);
    EXPECT_TRUE(out.converged);
  }
}

// The tool's surface then gives the direction out.
TEST(PenaltyMotion, PointsWithoutANormalPushTheSame) {
  PointCloud bare = sheet(20, 10);
  for (std::size_t i = 0; i < bare.size(); ++i) bare.nx[i] = bare.ny[i] = bare.nz[i] = std::nan("");
  const RenderOutput with = pressed(sheet(20, 10), -0.004), without = pressed(bare, -0.004);
  EXPECT_NEAR((without.proxy_W - with.proxy_W).norm(), 0, 1e-6);
  EXPECT_NEAR((without.force_N - with.force_N).norm(), 0, 1e-3);
}

// The hand feels the push of the point: its force, and its torque about the centre of mass.
TEST(PenaltyMotion, APointBesideTheMiddleTurnsTheTool) {
  const RenderOutput out = pressed(sheet(1, 1, 0.009), -0.001);
  const Vec3 r = Vec3(0.009, 0, 0) - out.proxy_W;
  EXPECT_GT(out.force_N.norm(), 0.1);
  EXPECT_NEAR((out.tool->torque_Nm - r.cross(out.force_N)).norm(), 0, 1e-5);
  EXPECT_GT(out.tool->torque_Nm.z(), 1e-3);
}

// The tool is not constrained: points beyond its middle push it through.
TEST(PenaltyMotion, PassesTheSurfaceIfItIsPressedHard) {
  EXPECT_LT(pressed(sheet(20, 10), -0.3).proxy_W.y(), -0.1);
}

// The sheet lies on the lower side of a layer of voxels, so the planes go through the voxels' middles:
// k (y - y_device) = 10 k_p (s / 2 - y)
// for the lower side y of the tool. Its points are not quite symmetric, so it tilts slightly.
TEST(PenaltyMotion, RestsOnTheMiddlesOfTheVoxelsOfAVoxmap) {
  constexpr double k = 600, k_p = 2400;
  for (const double voxel_m : {0.003, 0.004}) {
    ToolPenaltyParameters p;
    p.force_law = PenaltyLaw::voxmap, p.voxmap_voxel_m = voxel_m;
    const RenderOutput out = pressed(sheet(40, 40), -0.004, p);
    const double y_m = (10 * k_p * 0.5 * voxel_m - k * 0.004) / (k + 10 * k_p);
    EXPECT_NEAR(out.proxy_W.y() - kHalf_m.y(), y_m, 2e-5) << voxel_m;
    EXPECT_NEAR(out.force_N.y(), k * (y_m + 0.004), 0.012) << voxel_m;
    EXPECT_NEAR(out.tool->torque_Nm.norm(), 0, 0.02) << voxel_m;
    EXPECT_GE(out.tool->active_constraints, 10);
    EXPECT_TRUE(out.converged);
  }
}

// The map is empty behind the layer of voxels, so no force acts there.
TEST(PenaltyMotion, IsFreeBehindALayerOfVoxels) {
  ToolPenaltyParameters p;
  p.force_law = PenaltyLaw::voxmap;
  const RenderOutput out = pressed(sheet(40, 40), -0.3, p);
  EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y() - 0.3, 1e-6);
  EXPECT_EQ(out.force_N, Vec3::Zero());
}

// Compares a map that was made in advance with one that was not.
TEST(PenaltyMotion, APreparedVoxmapChangesNothing) {
  ToolPenaltyParameters p;
  p.force_law = PenaltyLaw::voxmap;
  ToolRenderer now = renderer(p), before = renderer(p);
  Frame frame = scenes::frame(sheet(40, 40));
  now.on_frame(frame);
  before.prepare(frame);
  before.on_frame(frame);
  for (int i = 0; i < 40; ++i) {
    const DeviceState d{{0.0002 * i, 0.008 - 0.0002 * i, 0}, rotation({0, 0, 0.01 * i})};
    const RenderOutput a = now.step(d, 0), b = before.step(d, 0);
    EXPECT_EQ(a.force_N, b.force_N);
    EXPECT_EQ(a.tool->torque_Nm, b.tool->torque_Nm);
    if (i == 39) {
      EXPECT_GT(a.force_N.norm(), 0.5);
    }
  }
}

// Half a voxel a step, so a tick moves the tool no farther than its steps do.
TEST(PenaltyMotion, ReportsWhenItsStepsDoNotSuffice) {
  ToolPenaltyParameters p;
  p.steps_per_tick = 4;
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(sheet(40, 40)));
  r.step({{0, 0.1, 0}, Eigen::Quaterniond::Identity()}, 0);
  const RenderOutput out = r.step({{0, 0.08, 0}, Eigen::Quaterniond::Identity()}, 0.001);
  EXPECT_NEAR(out.proxy_W.y(), 0.099, 1e-12);
  EXPECT_TRUE(out.tool->budget_exhausted);
  EXPECT_FALSE(out.converged);
}

}  // namespace
}  // namespace remote_touch::penalty_motion_test
