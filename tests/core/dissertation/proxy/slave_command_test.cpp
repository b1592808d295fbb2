// The command to the slave robot, 5.2: it follows the proxy, but never into a region.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace remote_touch::slave_command_test {
namespace {

PointCloud region(const Vec3& centre, double radius) {
  PointCloud cloud = scenes::cloud_of({centre});
  cloud.fixture_radius_m = {radius};
  return cloud;
}

// Two regions on a line with the proxy, which overlap once they are enlarged by the contact radius. The exit
// from either along this line ends inside the other, so a proxy between them moves to and fro for ever.
PointCloud trap() {
  PointCloud cloud = scenes::cloud_of({{-0.01, 0, 0}, {0.04, 0, 0}});
  cloud.fixture_radius_m = {0.02, 0.022};
  return cloud;
}

TEST(SlaveCommand, FollowsTheProxyWhereItIsOutside) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(region(Vec3::Zero(), 0.05)));
  int free = 0, contact = 0;
  for (int tick = 0; tick < 400; ++tick) {
    const double angle = 0.004 * tick, distance = 0.1 - 0.0003 * tick;
    const RenderOutput out =
        renderer.step({distance * Vec3(std::sin(angle), std::cos(angle), 0)}, 0.001 * tick);
    ASSERT_NE(out.state, ContactState::entrenched);
    ASSERT_EQ(out.slave_W, out.proxy_W) << tick;
    ++(out.state == ContactState::free ? free : contact);
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(contact, 50);
}

// The proxy stays inside under the printed rule.
TEST(SlaveCommand, IsHeldWhileTheProxyIsInsideARegion) {
  ProxyParameters p;
  p.max_exit_steps = 0;
  ProxyRenderer renderer = scenes::renderer(p);
  renderer.on_frame(scenes::frame(PointCloud{}));
  const Vec3 before(0, 0, 0), later(0.001, 0.1, 0);
  EXPECT_EQ(renderer.step({before}, 0).slave_W, before);
  renderer.on_frame(scenes::frame(trap(), 1));
  for (int tick = 1; tick < 50; ++tick) {
    const RenderOutput out = renderer.step({Vec3(0, 0.001 * tick, 0)}, 0.001 * tick);
    ASSERT_EQ(out.state, ContactState::entrenched) << tick;
    ASSERT_NE(out.proxy_W, before);
    ASSERT_EQ(out.slave_W, before) << tick;
  }
  renderer.on_frame(scenes::frame(PointCloud{}, 2));
  const RenderOutput out = renderer.step({later}, 0.051);
  EXPECT_EQ(out.proxy_W, later);
  EXPECT_EQ(out.slave_W, later);
}

// Steps of (5.11) never lead out here. A straight line does.
TEST(SlaveCommand, FollowsTheProxyOutOfATrap) {
  const PointCloud cloud = trap();
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(PointCloud{}));
  renderer.step({Vec3::Zero()}, 0);
  renderer.on_frame(scenes::frame(cloud, 1));
  for (int tick = 1; tick < 50; ++tick) {
    const RenderOutput out = renderer.step({Vec3(0, 0.001 * tick, 0)}, 0.001 * tick);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      ASSERT_GE((out.proxy_W - cloud.point(i)).norm() - cloud.fixture_radius_m[i], ProxyParameters{}.r1_m);
    ASSERT_EQ(out.slave_W, out.proxy_W) << tick;
  }
}

// A proxy that ends a tick inside a region may have been outside during the tick. The command is its latest
// position outside. A second renderer with one step a tick computes the positions within a tick of many
// steps.
TEST(SlaveCommand, IsTheLatestPositionOutsideWithinATick) {
  ProxyParameters many, one;
  many.velocity_estimate = one.velocity_estimate = false;
  many.steps_per_tick = 7, one.steps_per_tick = 1;
  ProxyRenderer renderer = scenes::renderer(many), single = scenes::renderer(one);
  for (ProxyRenderer* each : {&renderer, &single}) each->on_frame(scenes::frame(scenes::flat_grid(2, 0.002)));
  Vec3 outside = Vec3::Constant(std::nan(""));
  int held = 0, within = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const Vec3 hip(0.004 * std::sin(0.01 * tick), 0.01 - 0.00001 * tick, 0);
    const RenderOutput out = renderer.step({hip}, 0.001 * tick);
    bool passed = false;
    for (int step = 0; step < many.steps_per_tick; ++step) {
      const RenderOutput at = single.step({hip}, 0.001 * tick);
      if (at.state != ContactState::entrenched) outside = at.proxy_W, passed = true;
    }
    ASSERT_EQ(out.slave_W, outside) << tick;
    if (out.state == ContactState::entrenched) ++held, within += passed;
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(within, 10);
}

TEST(SlaveCommand, IsTheHipWhereTheConstraintIsSoft) {
  ProxyParameters soft;
  soft.slave_command = SlaveCommand::hip;
  ProxyRenderer renderer = scenes::renderer(soft), hard = scenes::renderer();
  for (ProxyRenderer* each : {&renderer, &hard}) each->on_frame(scenes::frame(region(Vec3::Zero(), 0.05)));
  for (int tick = 0; tick < 200; ++tick) {
    const Vec3 hip(0.001, 0.1 - 0.0005 * tick, 0);
    const RenderOutput out = renderer.step({hip}, 0.001 * tick), other = hard.step({hip}, 0.001 * tick);
    ASSERT_EQ(out.slave_W, hip) << tick;
    ASSERT_EQ(out.proxy_W, other.proxy_W) << "the hand feels the same";
    ASSERT_EQ(out.force_N, other.force_N);
  }
  renderer.on_frame(scenes::frame(trap(), 1));
  EXPECT_EQ(renderer.step({Vec3::Zero()}, 0.2).slave_W, Vec3(0, 0, 0)) << "inside or not";
}

TEST(SlaveCommand, IsHeldWhileTheDeviceIsLost) {
  for (const SlaveCommand command : {SlaveCommand::rendered, SlaveCommand::hip}) {
    ProxyParameters p;
    p.slave_command = command;
    ProxyRenderer renderer = scenes::renderer(p);
    const Vec3 lost(std::nan(""), 0, 0), far(1e9, 0, 0), last(0, 0.07, 0);
    EXPECT_TRUE(renderer.step({lost}, 0).slave_W.array().isNaN().all()) << "no command before the first step";
    EXPECT_EQ(renderer.step({last}, 0.001).slave_W, last) << "without a frame nothing is in the way";
    renderer.on_frame(scenes::frame(region(Vec3::Zero(), 0.05)));
    EXPECT_EQ(renderer.step({lost}, 0.002).slave_W, last);
    EXPECT_EQ(renderer.step({far}, 0.003).slave_W, last);
    EXPECT_EQ(renderer.step({Vec3(0, 0.08, 0)}, 0.004).slave_W, Vec3(0, 0.08, 0));
  }
}

// A hand that starts inside a region has no position to command until the proxy is outside. The proxy stays
// inside under the printed rule.
TEST(SlaveCommand, IsNoneUntilTheProxyWasOutside) {
  ProxyParameters p;
  p.max_exit_steps = 0;
  ProxyRenderer renderer = scenes::renderer(p);
  renderer.on_frame(scenes::frame(trap()));
  for (int tick = 0; tick < 5; ++tick)
    EXPECT_TRUE(renderer.step({Vec3(0.013, 0, 0)}, 0.001 * tick).slave_W.array().isNaN().all());
}

}  // namespace
}  // namespace remote_touch::slave_command_test
