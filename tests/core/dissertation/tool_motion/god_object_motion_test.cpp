// The god-object method compared with the pose of least energy, and with every point of the cloud.
#include "core/dissertation/tool_motion/god_object_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/dissertation/tool/shape/generated_tools.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/points/vector.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::god_object_motion_test {
namespace {

const Vec3 kHalf_m(0.02, 0.005, 0.01);
constexpr double kGap_m = ContinuousContacts::kGap_m;

ToolRenderer renderer(const ToolGodObjectParameters& p = {}) {
  static const std::shared_ptr<const VoxelTool> tool = scenes::outer_box_tool(kHalf_m);
  return {tool_parameters(p), tool, scenes::kernels(), std::make_unique<GodObjectMotion>(p, *tool)};
}

PointCloud sheet(double height_m = 0, double spacing_m = 0.002, int count = 41) {
  PointCloud cloud;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i)
      cloud.append({(i - count / 2) * spacing_m, height_m, (j - count / 2) * spacing_m}, Vec3::UnitY());
  return cloud;
}

DeviceState at(const Vec3& p_W, double about_z_rad = 0) {
  return {p_W, rotation({0, 0, about_z_rad})};
}

RenderOutput settled(ToolRenderer& r, const DeviceState& device, int ticks = 20) {
  RenderOutput out;
  for (int i = 0; i < ticks; ++i) out = r.step(device, 0);
  return out;
}

TEST(GodObjectMotion, ToolIsTheDeviceInFreeSpace) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet()));
  expect_free(r);
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

}  // namespace
}  // namespace remote_touch::god_object_motion_test
