// The motion of a tool of inner spheres against the balance of the coupling and the penetration volume.
#include "core/rivals/inner_sphere_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/points/vector.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::inner_sphere_motion_test {
namespace {

const Vec3 kHalf_m(0.02, 0.005, 0.01);

const std::shared_ptr<const VoxelTool>& tool() {
  static const std::shared_ptr<const VoxelTool> made = scenes::box_tool(kHalf_m);
  return made;
}
const std::shared_ptr<const InnerSpheres>& spheres() {
  static const auto made = std::make_shared<const InnerSpheres>(make_inner_spheres(*tool(), 500));
  return made;
}

ToolRenderer renderer(const InnerSphereParameters& p = {}) {
  return {tool_parameters(p), tool(), scenes::kernels(),
          std::make_unique<InnerSphereMotion>(p, *tool(), spheres())};
}

// Points at y = 0, 0.5 mm apart, symmetric about x = 0 and z = 0. Only those with x above low_x_m are there.
PointCloud sheet(double low_x_m = -1) {
  PointCloud cloud;
  for (int k = -28; k < 28; ++k)
    for (int i = -50; i < 50; ++i) {
      const Vec3 p = 5e-4 * Vec3(i + 0.5, 0, k + 0.5);
      if (p.x() > low_x_m) cloud.append(p, Vec3::UnitY());
    }
  return cloud;
}

DeviceState device(double lower_side_m) {
  return {{0, kHalf_m.y() + lower_side_m, 0}, Eigen::Quaterniond::Identity()};
}

// Output after 49 ticks with the device at a pose whose lower side is at this height.
RenderOutput pressed(const PointCloud& cloud, double lower_side_m, const InnerSphereParameters& p = {}) {
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(cloud));
  r.step(device(0.001), 0);
  RenderOutput out;
  for (int i = 1; i < 50; ++i) out = r.step(device(lower_side_m), 0.001 * i);
  return out;
}

double below_m3(double height_m) {
  double volume_m3 = 0;
  for (const Sphere& sphere : spheres()->spheres)
    volume_m3 += cap_behind(sphere.radius_m, sphere.centre.y() + height_m).volume_m3;
  return volume_m3;
}

TEST(InnerSphereMotion, ToolIsTheDeviceInFreeSpace) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet()));
  expect_free(r);
}

// k (y - y_device) = k_V V(y) for the height y of the tool.
TEST(InnerSphereMotion, SinksUntilVolumeAndSpringBalance) {
  constexpr double k = 600;
  for (const double k_v : {1e7, 1e8, 1e9})
    for (const double depth_m : {0.002, 0.01}) {
      InnerSphereParameters p;
      p.volume_stiffness_N_per_m3 = k_v;
      const RenderOutput out = pressed(sheet(), -depth_m, p);
      double low_m = kHalf_m.y() - depth_m, high_m = kHalf_m.y();
      for (int i = 0; i < 60; ++i) {
        const double y_m = 0.5 * (low_m + high_m);
        const bool is_too_low = k_v * below_m3(y_m) > k * (y_m - kHalf_m.y() + depth_m);
        (is_too_low ? low_m : high_m) = y_m;
      }
      EXPECT_NEAR(out.proxy_W.y(), low_m, 5e-5) << k_v << ", " << depth_m;
      EXPECT_NEAR(out.force_N.y(), k * (low_m - kHalf_m.y() + depth_m), 0.03) << k_v << ", " << depth_m;
      EXPECT_NEAR(std::hypot(out.force_N.x(), out.force_N.z()), 0, 1e-2);
      EXPECT_NEAR(out.tool->torque_Nm.norm(), 0, 1e-3);
      EXPECT_TRUE(out.converged);
    }
}

// The sheet supports the side of positive x only, so the hand feels a torque that lifts this side.
TEST(InnerSphereMotion, ASheetUnderOneSideTurnsTheTool) {
  const RenderOutput out = pressed(sheet(0.002), -0.003);
  EXPECT_GT(out.force_N.y(), 0.1);
  EXPECT_GT(out.tool->torque_Nm.z(), 1e-3);
  EXPECT_GT(out.tool->orientation_W.z(), 0);
}

// The cloud says nothing about its inside: what is behind the points is pushed out to their side. Farther
// behind the sheet the tool is free.
TEST(InnerSphereMotion, PushesAToolFromTheBackThroughTheSheet) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet()));
  RenderOutput out = r.step(device(-0.03), 0);
  EXPECT_EQ(out.force_N, Vec3::Zero());
  EXPECT_EQ(out.proxy_W, device(-0.03).position_W);
  for (int i = 0; i < 100; ++i) out = r.step(device(-0.02 + 1.2e-4 * i), 0.001 + 0.001 * i);
  EXPECT_GT(out.proxy_W.y(), kHalf_m.y() - 0.002);
  EXPECT_GT(out.force_N.y(), 0.5);
}

// A step moves no point by more than half a voxel, so a tick moves the tool no farther than its steps do.
TEST(InnerSphereMotion, ReportsWhenItsStepsDoNotSuffice) {
  InnerSphereParameters p;
  p.steps_per_tick = 4;
  ToolRenderer r = renderer(p);
  r.on_frame(scenes::frame(sheet()));
  r.step({{0, 0.1, 0}, Eigen::Quaterniond::Identity()}, 0);
  const RenderOutput out = r.step({{0, 0.08, 0}, Eigen::Quaterniond::Identity()}, 0.001);
  EXPECT_NEAR(out.proxy_W.y(), 0.099, 1e-12);
  EXPECT_TRUE(out.tool->budget_exhausted);
  EXPECT_FALSE(out.converged);
}

// Noise of 1 mm moves the balance to and fro: a point enters a sphere, pushes the tool up and leaves the
// sphere.
TEST(InnerSphereMotion, EndsItsTicksOnNoisyPoints) {
  PointCloud cloud = sheet();
  const PointCloud noise = scenes::random_cloud(static_cast<int>(cloud.size()), 1, 4);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.y[i] = 1e-3 * noise.y[i];
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(cloud));
  int exhausted = 0;
  for (int i = 0; i < 60; ++i) {
    const double down_m = std::min(0.003, 2e-4 * i);
    const RenderOutput out =
        r.step({{1e-4 * i, kHalf_m.y() + 0.002 - down_m, 0}, Eigen::Quaterniond::Identity()}, 0.001 * i);
    exhausted += out.tool->budget_exhausted ? 1 : 0;
    if (i == 59) {
      EXPECT_GT(out.force_N.y(), 0.5);
    }
  }
  EXPECT_LE(exhausted, 3);
}

TEST(InnerSphereMotion, PacksTheSpheresItself) {
  InnerSphereParameters p;
  p.inner_spheres = 500;
  ToolRenderer a = renderer(p);
  ToolRenderer b(tool_parameters(p), tool(), scenes::kernels(),
                 std::make_unique<InnerSphereMotion>(p, *tool()));
  for (ToolRenderer* r : {&a, &b}) r->on_frame(scenes::frame(sheet()));
  RenderOutput out;
  for (int i = 0; i < 20; ++i) {
    out = a.step(device(0.001 - 2e-4 * i), 0.001 * i);
    EXPECT_EQ(b.step(device(0.001 - 2e-4 * i), 0.001 * i).force_N, out.force_N);
  }
  EXPECT_GT(out.force_N.y(), 0.5);
}

}  // namespace
}  // namespace remote_touch::inner_sphere_motion_test
