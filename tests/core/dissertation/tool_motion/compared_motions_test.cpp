// The god-object method compared with the pose of least energy and with every point of the cloud, the voxmap
// with a set of all voxels that hold a point, the penalty rule with the balance of its springs.

#include "core/dissertation/tool_motion/compared_motions.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::compared_motions_test {
namespace {

const Vec3 kHalf_m(0.02, 0.005, 0.01);
constexpr double kGap_m = ContinuousContacts::kGap_m;

ToolRenderer renderer(const ToolGodObjectParameters& p = {}) {
  static const std::shared_ptr<const VoxelTool> tool = scenes::outer_box_tool(kHalf_m);
  return {tool_parameters(p), tool, scenes::kernels(), std::make_unique<GodObjectMotion>(p, *tool)};
}

PointCloud sheet(double height_m = 0, double spacing_m = 0.002, int count = 41) {
  return sheet_of({.columns = count, .rows = count, .spacing_m = spacing_m, .y_m = height_m});
}

DeviceState at(const Vec3& p_W, double about_z_rad = 0) {
  return {p_W, rotation({0, 0, about_z_rad})};
}

RenderOutput settled(ToolRenderer& r, const DeviceState& device, int ticks = 20) {
  RenderOutput out;
  for (int i = 0; i < ticks; ++i) out = r.step(device, 0);
  return out;
}

// A box over the plane y = 0, turned by theta about z, has its centre at a sin|theta| + b cos(theta) or
// higher. It rests where the two springs of the coupling have the least energy. The test finds that pose by
// trying all angles.
TEST(GodObjectMotion, RestsWhereTheSpringsHaveTheLeastEnergy) {
  constexpr double k = 600, r_g = 0.03;
  const auto height_m = [](double theta) {
    return kHalf_m.x() * std::abs(std::sin(theta)) + kHalf_m.y() * std::cos(theta) + kGap_m;
  };
  for (const double wanted : {0.0, 0.1, 0.3, -0.5, 0.8})
    for (const double depth_m : {0.002, 0.01}) {
      const double device_m = height_m(wanted) - depth_m;
      double best = 1e9, theta = 0;
      for (double t = -1.2; t < 1.2; t += 1e-5) {
        const double lag_m = height_m(t) - device_m;
        const double energy = 0.5 * k * (lag_m * lag_m + r_g * r_g * (t - wanted) * (t - wanted));
        if (energy < best) best = energy, theta = t;
      }
      ToolRenderer r = renderer();
      r.on_frame(scenes::frame(sheet()));
      settled(r, at({0, 0.05, 0}, wanted));
      const RenderOutput out = settled(r, at({0, device_m, 0}, wanted));
      const double lag_m = height_m(theta) - device_m;
      EXPECT_NEAR(out.force_N.y(), k * lag_m, 0.05) << wanted << ", " << depth_m;
      EXPECT_NEAR(out.tool->torque_Nm.z(), k * r_g * r_g * (theta - wanted), 1.5e-3)
          << wanted << ", " << depth_m;
      EXPECT_NEAR(std::hypot(out.force_N.x(), out.force_N.z()), 0, 0.02);
      EXPECT_TRUE(out.converged);
    }
}

// The exact distance of every point to the box is checked in every tick of a random path of the hand.
TEST(GodObjectMotion, NoPointGetsIntoTheTool) {
  const PointCloud cloud = sheet(0, 0.004, 31);
  std::mt19937 random(5);
  const auto uniform = [&] { return random() / 2147483648.0 - 1.0; };
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(cloud));
  r.step(at({0, 0.03, 0}), 0);
  double deepest_m = 1, held = 0;
  DeviceState from = at({0, 0.03, 0});
  for (int turn = 0; turn < 30; ++turn) {
    const DeviceState to{{0.02 * uniform(), 0.015 * uniform(), 0.02 * uniform()},
                         rotation(0.8 * Vec3(uniform(), uniform(), uniform()))};
    for (int i = 1; i <= 20; ++i) {
      const double s = i / 20.0;
      const RenderOutput out = r.step(
          {(1 - s) * from.position_W + s * to.position_W, from.orientation_W.slerp(s, to.orientation_W)}, 0);
      held += out.force_N.norm() > 0.5;
      for (std::size_t p = 0; p < cloud.size(); ++p)
        deepest_m = std::min(deepest_m, scenes::box_distance(kHalf_m, out.tool->orientation_W.conjugate() *
                                                                          (cloud.point(p) - out.proxy_W)));
    }
    from = to;
  }
  EXPECT_GT(deepest_m, -1e-5);
  EXPECT_GT(held, 100);
}

// The device moves in one tick from above to far below. No gap between the points is as wide as the tool.
TEST(GodObjectMotion, StopsAtTheFirstContactOfALongMotion) {
  ToolGodObjectParameters p;
  p.steps_per_tick = 200;
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(sheet()));
  r.step(at({0, 0.02, 0}), 0);
  const RenderOutput out = settled(r, at({0, -0.04, 0}), 1);
  EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y() + kGap_m, 1e-5);
}

// The coupling of the source gives no force for the part of the motion that the contacts allow. After the one
// step of a tick, the tool is still 19 mm behind along the plane, and no force acts along it.
TEST(GodObjectMotion, OnlyTheMotionThatContactsPreventIsFelt) {
  ToolGodObjectParameters p;
  ToolRenderer whole = renderer(p);
  p.steps_per_tick = 1;
  ToolRenderer slow = renderer(p);
  for (ToolRenderer* r : {&whole, &slow}) {
    r->on_frame(scenes::frame(sheet()));
    settled(*r, at({0, 0.02, 0}));
    settled(*r, at({0, 0.003, 0}), 100);
    const RenderOutput out = settled(*r, at({0.02, 0.003, 0}), 1);
    EXPECT_NEAR(out.proxy_W.x(), r == &slow ? 0.001 : 0.02, 1e-4);
    EXPECT_NEAR(out.force_N.x(), 0, 0.01);
    EXPECT_NEAR(out.force_N.y(), 600 * (0.002 + kGap_m), 0.01);
  }
}

// A surface that moves into a tool which waits at the device is not felt. A deeper motion of the device is
// felt.
TEST(GodObjectMotion, PointsThatAFramePutsIntoTheToolHoldItWhereItIs) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet(0, 0.0019), 0));
  settled(r, at({0, 0.006, 0}));
  r.on_frame(scenes::frame(sheet(0.003, 0.0019), 1));
  RenderOutput out = settled(r, at({0, 0.006, 0}));
  EXPECT_EQ(out.force_N, Vec3::Zero());
  EXPECT_EQ(out.proxy_W.y(), 0.006);
  out = settled(r, at({0, 0.004, 0}));
  EXPECT_NEAR(out.proxy_W.y(), 0.006, 1e-4);
  EXPECT_NEAR(out.force_N.y(), 600 * 0.002, 600 * 1e-4);
  out = settled(r, at({0, 0.02, 0}));
  EXPECT_EQ(out.proxy_W.y(), 0.02);
}

// Whatever the shape: where a tick has converged, contacts prevent all of the motion that is left, and the
// hand feels it. The hand presses every built-in tool into a plane, slides and turns it.
TEST(GodObjectMotion, AToolAtRestOnAPlaneIsFeltInEveryTick) {
  const PointCloud cloud = sheet(0, 0.003, 61);
  std::mt19937 random(3);
  const auto uniform = [&] { return random() / 2147483648.0 - 1.0; };
  ToolGodObjectParameters p;
  p.coupling.max_force_N = 1000;
  for (const GeneratedTool& shape : generated_tools()) {
    ToolReport made;
    const auto tool = std::make_shared<const VoxelTool>(
        make_voxel_tool(shape.make(), {1e-3, 0.04, false, true}, made, shape.name));
    ToolRenderer r(tool_parameters(p), tool, scenes::kernels(), std::make_unique<GodObjectMotion>(p, *tool));
    r.on_frame(scenes::frame(cloud));
    int pressed = 0, converged = 0;
    for (int way = 0; way < 4; ++way) {
      Vec3 position_W(0.01 * uniform(), 0.05, 0.01 * uniform());
      const Vec3 to_W(0.03 * uniform(), 0, 0.03 * uniform()), turn = Vec3(uniform(), uniform(), uniform());
      const Eigen::Quaterniond from = rotation(3 * turn), to = rotation(0.3 * turn) * from;
      for (int tick = 0; tick < 200; ++tick) {
        position_W.y() = std::max(0.002, position_W.y() - 0.0005);
        position_W += 0.005 * (to_W - Vec3(position_W.x(), 0, position_W.z()));
        const RenderOutput out = r.step({position_W, from.slerp(tick / 200.0, to)}, 0.001 * tick);
        const double lag_m = (position_W - out.proxy_W).norm();
        if (lag_m < 2e-4) continue;
        ++pressed, converged += out.converged;
        const double felt_N = out.converged ? out.force_N.norm() : p.coupling.max_force_N;
        ASSERT_GE(felt_N, 0.9 * p.coupling.stiffness_N_per_m * lag_m)
            << shape.name << ", way " << way << ", tick " << tick;
      }
    }
    EXPECT_GT(pressed, 300) << shape.name;
    EXPECT_GT(converged, 0.8 * pressed) << shape.name;
  }
}

// The walls leave less room than the gap. J a >= 0 still has a solution.
TEST(GodObjectMotion, WaitsBetweenWallsThatAreTooNear) {
  PointCloud walls = sheet(-0.00502);
  for (int j = -20; j <= 20; ++j)
    for (int i = -20; i <= 20; ++i) walls.append({0.002 * i, 0.00502, 0.002 * j}, -Vec3::UnitY());
  ToolRenderer r = renderer();
  settled(r, at({0, 0, 0}));
  r.on_frame(scenes::frame(walls));
  const RenderOutput out = settled(r, at({0, -0.002, 0}));
  EXPECT_NEAR(out.proxy_W.y(), 0, 3e-5);
  EXPECT_NEAR(out.force_N.y(), 600 * 0.002, 600 * 3e-5);
}

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

ToolRenderer renderer(const ToolPenaltyParameters& p) {
  const auto tool = scenes::box_tool(kHalf_m);
  return {tool_parameters(p), tool, scenes::kernels(), make_penalty_motion(p, *tool)};
}

// columns x rows points at y = 0, 2 mm apart. No point is nearer than 1 mm to an edge of the tool.
PointCloud grid(int columns, int rows, double x_m = 0) {
  return sheet_of({.columns = columns, .rows = rows, .x_m = x_m});
}

// Output after 49 ticks with the device at a pose whose lower side is at this height.
RenderOutput pressed(const PointCloud& cloud, double lower_side_m, const ToolPenaltyParameters& p = {}) {
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(cloud));
  r.step(at({0, kHalf_m.y() + 0.001, 0}), 0);
  RenderOutput out;
  for (int i = 1; i < 50; ++i) out = r.step(at({0, kHalf_m.y() + lower_side_m, 0}), 0.001 * i);
  return out;
}

// Balance of the springs at the depth s: k (D - s) = min(N, 10) k_p s for N points and the device's depth D.
TEST(PenaltyMotion, SinksUntilTheSpringsBalance) {
  constexpr double k = 600, k_p = 2400, pressed_m = 0.004;
  for (const auto& [columns, rows, pushing] : {std::tuple{20, 10, 10}, {5, 2, 10}, {3, 2, 6}}) {
    const RenderOutput out = pressed(grid(columns, rows), -pressed_m);
    const double sinks_m = k * pressed_m / (k + pushing * k_p);
    EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y() - sinks_m, 1e-6) << columns;
    EXPECT_NEAR(out.force_N.y(), k * (pressed_m - sinks_m), 1e-3) << columns;
    EXPECT_EQ(out.tool->active_constraints, columns * rows);
    EXPECT_TRUE(out.converged);
  }
}

// The tool's surface then gives the direction out.
TEST(PenaltyMotion, PointsWithoutANormalPushTheSame) {
  PointCloud bare = grid(20, 10);
  for (std::size_t i = 0; i < bare.size(); ++i) bare.nx[i] = bare.ny[i] = bare.nz[i] = std::nan("");
  const RenderOutput with = pressed(grid(20, 10), -0.004), without = pressed(bare, -0.004);
  EXPECT_NEAR((without.proxy_W - with.proxy_W).norm(), 0, 1e-6);
  EXPECT_NEAR((without.force_N - with.force_N).norm(), 0, 1e-3);
}

// The hand feels the push of the point: its force, and its torque about the centre of mass.
TEST(PenaltyMotion, APointBesideTheMiddleTurnsTheTool) {
  const RenderOutput out = pressed(grid(1, 1, 0.009), -0.001);
  const Vec3 r = Vec3(0.009, 0, 0) - out.proxy_W;
  EXPECT_GT(out.force_N.norm(), 0.1);
  EXPECT_NEAR((out.tool->torque_Nm - r.cross(out.force_N)).norm(), 0, 1e-5);
  EXPECT_GT(out.tool->torque_Nm.z(), 1e-3);
}

// The sheet lies on the lower side of a layer of voxels, so the planes go through the voxels' middles:
// k (y - y_device) = 10 k_p (s / 2 - y)
// for the lower side y of the tool. Its points are not quite symmetric, so it tilts slightly.
TEST(PenaltyMotion, RestsOnTheMiddlesOfTheVoxelsOfAVoxmap) {
  constexpr double k = 600, k_p = 2400;
  for (const double voxel_m : {0.003, 0.004}) {
    ToolPenaltyParameters p;
    p.force_law = PenaltyLaw::voxmap, p.voxmap_voxel_m = voxel_m;
    const RenderOutput out = pressed(grid(40, 40), -0.004, p);
    const double y_m = (10 * k_p * 0.5 * voxel_m - k * 0.004) / (k + 10 * k_p);
    EXPECT_NEAR(out.proxy_W.y() - kHalf_m.y(), y_m, 2e-5) << voxel_m;
    EXPECT_NEAR(out.force_N.y(), k * (y_m + 0.004), 0.012) << voxel_m;
    EXPECT_NEAR(out.tool->torque_Nm.norm(), 0, 0.02) << voxel_m;
    EXPECT_GE(out.tool->active_constraints, 10);
    EXPECT_TRUE(out.converged);
  }
}

// The tool is not constrained: points beyond its middle push it through. A voxmap is empty behind the layer
// of voxels, so no force acts there.
TEST(PenaltyMotion, PassesTheSurfaceIfItIsPressedHard) {
  EXPECT_LT(pressed(grid(20, 10), -0.3).proxy_W.y(), -0.1);
  ToolPenaltyParameters p;
  p.force_law = PenaltyLaw::voxmap;
  const RenderOutput out = pressed(grid(40, 40), -0.3, p);
  EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y() - 0.3, 1e-6);
  EXPECT_EQ(out.force_N, Vec3::Zero());
}

// Half a voxel a step, so a tick moves the tool no farther than its steps do.
TEST(PenaltyMotion, ReportsWhenItsStepsDoNotSuffice) {
  ToolPenaltyParameters p;
  p.steps_per_tick = 4;
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(grid(40, 40)));
  r.step(at({0, 0.1, 0}), 0);
  const RenderOutput out = r.step(at({0, 0.08, 0}), 0.001);
  EXPECT_NEAR(out.proxy_W.y(), 0.099, 1e-12);
  EXPECT_TRUE(out.tool->budget_exhausted);
  EXPECT_FALSE(out.converged);
}

}  // namespace
}  // namespace remote_touch::compared_motions_test
