// The 6-DOF renderer at its edges: odd clouds, odd devices, odd frames.
#include "core/dissertation/tool_motion/tool_renderer.h"

#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "core/points/vector.h"
#include "tests/core/dissertation/tool_motion/free_space.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::tool_renderer_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Vec3 kHalf_m(0.02, 0.005, 0.01);

PointCloud sheet(double spacing_m = 0.002) {
  return sheet_of({.columns = 60, .rows = 60, .spacing_m = spacing_m});
}

ToolRenderer renderer(ContactRule rule = ContactRule::look_ahead, ToolParameters p = {}) {
  p.contact_rule = rule;
  const bool is_outer = rule == ContactRule::continuous;
  return ToolRenderer(p, is_outer ? scenes::outer_box_tool(kHalf_m) : scenes::box_tool(kHalf_m),
                      scenes::kernels());
}

DeviceState device(const Vec3& p_W, const Vec3& turn = Vec3::Zero()) {
  return {p_W, rotation(turn)};
}

// Motions end after the given number of successive steps that come no nearer than the nearest one, by more
// than the threshold.
TEST(MotionProgress, EndsAfterTheGivenNumberOfStepsWithoutProgress) {
  const auto ended_after = [](double threshold, const std::vector<double>& left) {
    MotionProgress progress(threshold, 2);
    for (std::size_t i = 0; i < left.size(); ++i) {
      progress.update(left[i]);
      if (progress.has_ended()) return static_cast<int>(i) + 1;
    }
    return 0;
  };
  EXPECT_EQ(ended_after(0.125, {10, 9.75, 9.5, 9.25, 9, 8.75}), 0) << "it comes nearer";
  EXPECT_EQ(ended_after(0.125, {10, 9.875, 11, 12}), 3) << "by the threshold is no progress";
  EXPECT_EQ(ended_after(0, {10, 12, 9, 11, 9.5, 20}), 5) << "nearer than the step before, not the nearest";
}

class EveryRule : public testing::TestWithParam<ContactRule> {};
INSTANTIATE_TEST_SUITE_P(
    Tool, EveryRule, testing::Values(ContactRule::look_ahead, ContactRule::voxels, ContactRule::continuous),
    [](const auto& rule) {
      return (std::array{"look_ahead", "voxels", "continuous"}[static_cast<std::size_t>(rule.param)]);
    });

TEST_P(EveryRule, ToolIsTheDeviceInFreeSpace) {
  ToolRenderer r = renderer(GetParam());
  r.on_frame(scenes::frame(sheet()));
  expect_free(r);
}

// Output after 100 ticks in which the device goes down from 0.02 m.
RenderOutput lowered(ToolRenderer& r, double by_m) {
  RenderOutput out;
  for (int i = 0; i <= 100; ++i) out = r.step(device({0, 0.02 - by_m * (0.01 * i), 0}), 0.001 * i);
  return out;
}

TEST_P(EveryRule, OnePointHoldsTheToolAndACloudWithoutUsablePointsDoesNot) {
  PointCloud none, unmeasured, one;
  for (int i = 0; i < 50; ++i) unmeasured.append(Vec3::Constant(kNaN), Vec3::Constant(kNaN));
  one.append({0, 0, 0}, Vec3::UnitY());
  for (const PointCloud& cloud : {none, unmeasured, one}) {
    ToolRenderer r = renderer(GetParam());
    r.on_frame(scenes::frame(cloud));
    const bool holds = cloud.size() == 1;
    EXPECT_NEAR(lowered(r, 0.04).proxy_W.y(), holds ? kHalf_m.y() : -0.02, holds ? 6e-4 : 1e-16);
  }
}

// Points without a normal are counted. They have no effect under the printed rule, which has no direction for
// them.
TEST_P(EveryRule, PointsWithoutANormalAreCounted) {
  PointCloud cloud = sheet();
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.nx[i] = cloud.ny[i] = cloud.nz[i] = kNaN;
  ToolRenderer r = renderer(GetParam());
  r.on_frame(scenes::frame(cloud));
  const RenderOutput out = lowered(r, 0.03);
  EXPECT_EQ(out.tool->disabled_points, 3600);
  if (GetParam() == ContactRule::voxels) {
    EXPECT_NEAR(out.proxy_W.y(), -0.01, 1e-16);
  } else {
    EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y(), 2e-4);
  }
}

// The device leaps across the cloud, or begins inside.
TEST_P(EveryRule, AToolEndsOnTheSideOfTheSensor) {
  for (const auto& [start_m, end_W] : {std::pair(0.05, Vec3(0.02, -0.05, 0)), {0.001, Vec3(0, 0.001, 0)}}) {
    ToolRenderer r = renderer(GetParam());
    r.on_frame(scenes::frame(sheet()));
    r.step(device({0, start_m, 0}), 0);
    RenderOutput out;
    for (int i = 1; i <= 200; ++i) out = r.step(device(end_W), 0.001 * i);
    EXPECT_NEAR(out.proxy_W.y(), kHalf_m.y(), 6e-4);
    EXPECT_NEAR(out.proxy_W.x(), end_W.x(), 1e-3);
  }
}

TEST_P(EveryRule, ANonFiniteDeviceGivesNoForceAndAFiniteProxy) {
  ToolRenderer r = renderer(GetParam());
  r.on_frame(scenes::frame(sheet()));
  RenderOutput held;
  for (int i = 0; i < 50; ++i) held = r.step(device({0, 0.002, 0}), 0.001 * i);
  EXPECT_GT(held.force_N.norm(), 0.1);
  DeviceState lost[4] = {device({kNaN, 0, 0}), device({0, 0, 1e9}), device({0, 0, 0}), device({0, 0, 0})};
  lost[2].orientation_W.coeffs().setConstant(kNaN);
  lost[3].orientation_W.coeffs().setZero();
  for (const DeviceState& d : lost) {
    const RenderOutput out = r.step(d, 0.06);
    EXPECT_EQ(out.status, RenderStatus::device_not_finite);
    EXPECT_EQ(out.force_N, Vec3::Zero());
    EXPECT_EQ(out.tool->torque_Nm, Vec3::Zero());
    EXPECT_EQ(out.proxy_W, held.proxy_W);
  }
  EXPECT_EQ(r.step(device({0, 0.002, 0}), 0.07).force_N, held.force_N);
}

// 5.2 for a tool: a hard constraint on the slave robot, or a soft one.
TEST_P(EveryRule, TheSlaveFollowsTheToolOrTheDevice) {
  ToolParameters p;
  for (const SlaveCommand command : {SlaveCommand::rendered, SlaveCommand::hip}) {
    p.slave_command = command;
    ToolRenderer r = renderer(GetParam(), p);
    const DeviceState lost = device(Vec3::Constant(kNaN));
    EXPECT_TRUE(r.step(lost, 0).slave_W.array().isNaN().all()) << "no device is known";
    r.on_frame(scenes::frame(sheet()));
    EXPECT_TRUE(r.step(lost, 0).slave_W.array().isNaN().all());
    RenderOutput out = lowered(r, 0.03);
    const Vec3 device_W(0, 0.02 - 0.03, 0);
    ASSERT_GT((out.proxy_W - device_W).norm(), 0.01);  // the points hold it
    const Vec3 expected = command == SlaveCommand::rendered ? out.proxy_W : device_W;
    EXPECT_EQ(out.slave_W, expected);
    out = r.step(lost, 0.3);
    EXPECT_EQ(out.slave_W, expected);  // the last command is repeated
  }
}

TEST(ToolRenderer, StaleFramesAreDroppedAndReported) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet(), 3));
  r.on_frame(scenes::frame({}, 2));
  const RenderOutput out = r.step(device({0, 0.05, 0}), 0.101);
  EXPECT_EQ(out.status, RenderStatus::stale_frame_dropped);
  EXPECT_EQ(out.frame_index, 3);
  EXPECT_EQ(r.step(device({0, 0.05, 0}), 0.102).status, RenderStatus::ok);
}

// Scene and device, turned and moved as one, give the same run, turned and moved, up to the length of a step
// that ends a tick. This test once found walls between the points of a flat surface, where there are none.
TEST(ToolRenderer, TheWorldFrameDoesNotMatter) {
  const RigidTransform X = Eigen::Translation3d(0.3, -0.2, 0.5) * rotation({0.4, -0.7, 0.2});
  PointCloud rotated;
  const PointCloud flat = sheet();
  for (std::size_t i = 0; i < flat.size(); ++i)
    rotated.append(X * flat.point(i), X.linear() * flat.normal(i));
  ToolRenderer a = renderer(), b = renderer();
  a.on_frame(scenes::frame(flat)), b.on_frame(scenes::frame(rotated));
  for (int i = 0; i < 600; ++i) {
    const DeviceState d = device({5e-5 * i, 0.02 - 4e-5 * i, 0.001}, {0.2, 0.001 * i, 0.1});
    const DeviceState e{X * d.position_W, Eigen::Quaterniond(X.linear()) * d.orientation_W};
    const RenderOutput out = a.step(d, 0.001 * i), other = b.step(e, 0.001 * i);
    EXPECT_LT((X * out.proxy_W - other.proxy_W).norm(), 1e-5) << i;
    EXPECT_LT((X.linear() * out.force_N - other.force_N).norm(), 1e-2) << i;
  }
}

// A corner that slides over bare points would catch between them. Their disks let it glide: the tool keeps
// its height within 0.2 mm while the device moves on.
TEST(ToolRenderer, SlidesWithoutRipple) {
  ToolRenderer r = renderer();
  r.on_frame(scenes::frame(sheet(0.003)));
  double low = 1, high = -1;
  for (int i = 0; i < 1500; ++i) {
    const RenderOutput out = r.step(device({2e-5 * i, 0.004, 1e-5 * i}, {0.35, 0.2, 0.5}), 0.001 * i);
    if (i < 100) continue;
    low = std::min(low, out.proxy_W.y()), high = std::max(high, out.proxy_W.y());
    EXPECT_LT(out.tool->tool_penetration_m, 1e-4);
    EXPECT_GT(out.tool->active_constraints, 0);
  }
  EXPECT_LT(high - low, 2e-4);
}

// A walk through clutter: no output is NaN, and the tool is never deeper than a voxel while the frame rests.
TEST_P(EveryRule, IsNeverDeeperThanAVoxelOnAWalkThroughClutter) {
  PointCloud clutter = sheet();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.05, 0.05);
  for (int ball = 0; ball < 12; ++ball) {  // balls of radius 8 mm on the sheet
    const double x = place(random), z = place(random);
    for (int k = 0; k < 400; ++k) {
      const double v = 2 * (k + 0.5) / 400 - 1, turn = 2.399963 * k, w = std::sqrt(1 - v * v);
      const Vec3 n(w * std::cos(turn), v, w * std::sin(turn));
      clutter.append(Vec3(x, 0.006, z) + 0.008 * n, n);
    }
  }
  ToolRenderer r = renderer(GetParam());
  r.on_frame(scenes::frame(clutter));
  int touching = 0;
  for (int i = 0; i < 8000; ++i) {
    const double t = 0.001 * i;
    const DeviceState d =
        device({0.04 * std::sin(1.1 * t), 0.012 + 0.02 * std::sin(1.7 * t), 0.04 * std::sin(0.9 * t)},
               {0.6 * std::sin(0.8 * t), 0.9 * std::sin(0.5 * t), 0.7 * std::sin(0.7 * t)});
    const RenderOutput out = r.step(d, t);
    ASSERT_TRUE(out.proxy_W.allFinite() && out.force_N.allFinite() && out.tool->torque_Nm.allFinite() &&
                out.tool->orientation_W.coeffs().allFinite());
    EXPECT_LE(out.tool->detections, 60);
    if (!out.tool->budget_exhausted) {
      EXPECT_LE(out.tool->tool_penetration_m, 5e-4) << i;
    }
    touching += out.contact_count > 0;
  }
  EXPECT_GT(touching, 2000);
}

}  // namespace
}  // namespace remote_touch::tool_renderer_test
