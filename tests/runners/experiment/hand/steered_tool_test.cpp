// A slave with a tool behind its links: orientations that are sent, torques that come back, and experiments.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::steered_tool_test {
namespace {

constexpr double kTick_s = 0.001;

SlaveScene ground() {
  return {[](const Vec3& p, double) { return p.y(); }, [](const Vec3&, double) { return Vec3(0, 1, 0); }};
}

// A tool of one point, 3 cm beside its centre of mass and 1 cm below.
TeleoperationSettings with(Feedback force, int delay_ticks = 0) {
  TeleoperationSettings s;
  s.feedback.force = force;
  s.commands.channel.delay_s = s.forces.channel.delay_s = delay_ticks * kTick_s;
  s.tool = SlaveTool{{{0.03, -0.01, 0}}, {1e-4}, 0.02, 0.04};
  return s;
}

DeviceState device(double y, const Vec3& turn) {
  DeviceState d;
  d.position_W = Vec3(0, y, 0), d.orientation_W = rotation(turn);
  return d;
}

TEST(SteeredTool, TheOrientationTravelsWithTheCommand) {
  for (const int delay : {0, 30}) {
    TeleoperationSettings s = with(Feedback::none, delay);
    s.slave.natural_frequency_hz = 20;
    Teleoperation remote(s, {}, kTick_s, ground());
    double largest = 0;
    for (int i = 0; i < 1500; ++i) {
      const double t = i * kTick_s;
      remote.tick(device(1, {0, 0, 0.5 * t}), {}, t);
      const double late = t - (delay + 1) * kTick_s;  // of the command that the slave has reached
      const double lag = remote.state().tool->orientation_W.angularDistance(rotation({0, 0, 0.5 * late}));
      if (i > 1000) largest = std::max(largest, lag);
    }
    EXPECT_LT(largest, 1e-4) << delay;  // the drive knows the speed of the command
  }
}

TEST(SteeredTool, FollowsTheToolOfTheRendererOrTheDevice) {
  const Teleoperation remote(with(Feedback::rendered), {}, kTick_s, ground());
  RenderOutput out;
  out.tool.emplace().orientation_W = rotation({0, 1, 0});
  out.proxy_W = out.slave_W = Vec3(1, 2, 3);
  const DeviceState hand = device(0.5, {1, 0, 0});
  EXPECT_EQ(remote.command_orientation(hand, out).coeffs(), out.tool->orientation_W.coeffs());
  out.slave_W = hand.position_W;  // a renderer with slave_command = hip
  EXPECT_EQ(remote.command_orientation(hand, out).coeffs(), hand.orientation_W.coeffs());
  out.slave_W = out.proxy_W;
  const Teleoperation direct(with(Feedback::slave_force), {}, kTick_s, ground());
  EXPECT_EQ(direct.command_orientation(hand, out).coeffs(), hand.orientation_W.coeffs());
}

TEST(SteeredTool, ForceAndTorqueComeBackAfterTheDelay) {
  for (const int delay : {0, 30}) {
    TeleoperationSettings s = with(Feedback::slave_force, delay);
    s.feedback.gain = 0.5;
    Teleoperation remote(s, {}, kTick_s, ground());
    std::vector<SlaveState> states;
    for (int i = 0; i < 1000; ++i) {
      const Wrench felt =
          remote.tick(device(std::max(0.02 - 0.05 * i * kTick_s, 0.0), Vec3::Zero()), {}, i * kTick_s);
      states.push_back(remote.state());
      if (i < delay) continue;
      const SlaveState& sent = states[static_cast<std::size_t>(i - delay)];
      ASSERT_EQ(felt.force_N, 0.5 * sent.force_N) << i;
      ASSERT_EQ(felt.torque_Nm, 0.5 * sent.tool->torque_Nm) << i;
    }
    EXPECT_GT(states.back().force_N.y(), 1) << delay;
    EXPECT_GT(states.back().tool->torque_Nm.z(), 0.02) << delay;  // the arm is along x, the force along y
  }
}

TEST(SteeredTool, WaitsForACommandWithAnOrientation) {
  Teleoperation remote(with(Feedback::none), {}, kTick_s, ground());
  DeviceState hand = device(1, Vec3::Zero());
  hand.orientation_W.coeffs().setZero();
  remote.tick(hand, {}, 0);
  ASSERT_TRUE(remote.state().tool);
  EXPECT_TRUE(std::isnan(remote.state().tool->orientation_W.w()));
  remote.tick(device(1, Vec3::Zero()), {}, kTick_s);
  EXPECT_EQ(remote.state().tool->orientation_W.w(), 1);
  remote.tick(hand, {}, 2 * kTick_s);
  EXPECT_EQ(remote.state().command_packets, 1);
}

// The hand turns, and at times moves too, and then rests until the slave has reached the command that it has
// received. There no point of the tool is farther from where the hand commands it than the dead-band allows.
TEST(SteeredTool, ADeadBandBoundsTheErrorOfThePoseAtTheTool) {
  for (const bool predicts : {false, true}) {
    TeleoperationSettings s = with(Feedback::none);
    s.slave.natural_frequency_hz = 20;
    s.commands.dead_band.least = 0.002, s.commands.dead_band.predicts = predicts;
    s.commands.dead_band.longest_silence_s = predicts ? 0.3 : 0;  // a prediction would go on while it rests
    Teleoperation remote(s, {}, kTick_s, ground());
    double turned = 0, y = 1, largest_m = 0;
    for (int i = 0; i < 10000; ++i) {
      const bool moves = i % 1000 < 117;
      if (moves) turned += 1e-3;
      if (moves && i > 5000) y += 1e-5;
      const DeviceState hand = device(y, turned * Vec3(0.6, 0, 0.8));
      remote.tick(hand, {}, i * kTick_s);
      if (i % 1000 < 999) continue;
      const SlaveState& slave = remote.state();
      const Vec3& p_T = s.tool->points_T.front();
      const Vec3 wanted_W = hand.position_W + hand.orientation_W * p_T;
      largest_m = std::max(largest_m, (slave.position_W + slave.tool->orientation_W * p_T - wanted_W).norm());
    }
    EXPECT_LE(largest_m, 0.002 + 1e-9) << predicts;
    EXPECT_LT(remote.state().command_packets, 100) << predicts;
    EXPECT_GT(remote.state().command_packets, 1170 * 1e-3 * 0.04 / 0.002 / 2) << predicts;
    EXPECT_GT(rotation_vector(remote.state().tool->orientation_W).norm(), 1.1) << predicts;
  }
}

TEST(SteeredTool, AllocatesNothingInATick) {
  TeleoperationSettings s = with(Feedback::slave_force, 20);
  Teleoperation remote(s, {}, kTick_s, ground());
  double peak_N = 0;
  const auto steer = [&](int i) {
    remote.tick(device(std::max(0.02 - 0.05 * i * kTick_s, 0.0), {0.1, 0, 0}), {}, i * kTick_s);
    peak_N = std::max(peak_N, remote.state().peak_force_N);
  };
  steer(0);
  const std::size_t before = allocation_count();
  for (int i = 1; i < 1000; ++i) {
    if (i % 100 < 90) steer(i);
  }
  EXPECT_EQ(allocation_count(), before);
  EXPECT_GT(peak_N, 1);
}

Trace run(const std::vector<std::string>& overrides) {
  return simulate(Experiment::load("steer-tool", overrides), {});
}

// Over the surface, the slave without a delay comes to the pose of the rendered tool.
TEST(SteeredTool, CoincidesWithTheRenderedTool) {
  const Trace trace = run(
      {R"(trajectory={"name": "poses", "poses": [[0, 0.05, 0, 0, 0, 0, 0], [0.01, 0.06, 0, 10, 0, 20, 0.2]]})",
       "duration_s=0.5", "command_link.delay_s=0", "slave.natural_frequency_hz=20"});
  ASSERT_TRUE(trace.has_slave_tool());
  const std::size_t last = trace.length() - 1;
  EXPECT_NEAR((trace.slave_position_m[last] - trace.proxy_position_m[last]).norm(), 0, 1e-4);
  EXPECT_NEAR(trace.slave_orientation[last].angularDistance(trace.tool_orientation[last]), 0, 1e-4);
  EXPECT_GT(trace.slave_orientation[last].angularDistance(Eigen::Quaterniond::Identity()), 0.3);
  EXPECT_EQ(trace.slave_torque_Nm[last], Vec3::Zero());
}

// The hand only turns, by 20 degrees. The plate reaches about 7 cm, so it may be 1 mm / 7 cm = 0.8 degrees
// behind.
TEST(SteeredTool, ADeadBandSendsARotationAlone) {
  const Trace trace = run(
      {R"(trajectory={"name": "poses", "poses": [[0, 0.05, 0, 0, 0, 0, 0], [0, 0.05, 0, 0, 0, 20, 0.2]]})",
       "duration_s=0.7", "command_link.least=0.001", "slave.natural_frequency_hz=20"});
  const std::size_t last = trace.length() - 1;
  EXPECT_LT(trace.slave_orientation[last].angularDistance(trace.tool_orientation[last]), 0.03);
  EXPECT_GT(trace.slave_orientation[last].angularDistance(Eigen::Quaterniond::Identity()), 0.3);
  EXPECT_GT(trace.command_packets[last], 10);
  EXPECT_LT(trace.command_packets[last], 100);
}

// The hand turns at a constant rate, which the drive knows, so the slave is behind by the delay and one tick.
TEST(SteeredTool, TheLagInRotationIsThatOfTheDelay) {
  const Trace trace =
      run({R"(trajectory={"name": "poses", "poses": [[0, 0.05, 0, 0, 0, 0, 0], [0, 0.05, 0, 0, 0, 60, 1]]})",
           "duration_s=1", "command_link.delay_s=0.05", "slave.natural_frequency_hz=20"});
  const double rate_rad_per_s = trace.hip_orientation.back().angularDistance(trace.hip_orientation[500]) /
                                (trace.time_s.back() - trace.time_s[500]);
  // The slave starts at rest, so it is behind by less in the first 5 % of the run.
  EXPECT_NEAR(rms_slave_lag_angle_rad(trace), rate_rad_per_s * 0.051, 0.05 * rate_rad_per_s * 0.051);
}

// The plate, which the hand holds level, lands on the tilted surface with its edge, so the surface turns it.
TEST(SteeredTool, TheSurfaceTurnsTheSlave) {
  const Trace trace = run({"feedback.force=none"});
  double force_N = 0, torque_Nm = 0, turned = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    force_N = std::max(force_N, trace.slave_force_N[i].norm());
    torque_Nm = std::max(torque_Nm, trace.slave_torque_Nm[i].norm());
    turned = std::max(turned, trace.slave_orientation[i].angularDistance(Eigen::Quaterniond::Identity()));
  }
  EXPECT_GT(force_N, 5);
  EXPECT_GT(torque_Nm, 0.01);
  EXPECT_GT(turned, 0.05);
  EXPECT_LT(turned, 0.3);
}

// A surface may touch the end of a tool first, far from its origin.
TEST(SteeredTool, TheDeadBandOfFramesReachesBeyondTheTool) {
  const auto near_m = [](const std::vector<std::string>& set) {
    return Experiment::load("steer-tool", set).frame_dead_band().near_m;
  };
  const std::string band = "frame_link.least_motion_m=0.001", bar = "renderer.tool_mesh=bar";
  const double small_m = near_m({band, bar, "renderer.tool_size_m=0.05"});
  const double large_m = near_m({band, bar, "renderer.tool_size_m=0.1"});
  EXPECT_GT(small_m, 0.04 + 0.02);
  EXPECT_NEAR(large_m - 0.04, 2 * (small_m - 0.04), 1e-9);
}

TEST(SteeredTool, RefusesWhatASlaveWithAToolDoesNotHave) {
  const auto why = [](const std::string& setting) {
    return refusal([&] { Experiment::load("steer-tool", {setting}); });
  };
  for (const std::string force : {"passive-slave-force", "position-position", "wave"})
    EXPECT_HAS(why("feedback.force=" + force), "feedback.force = " + force + ": expected another");
  EXPECT_HAS(why("slave.radius_m=0.01"), "slave.radius_m = 0.01");
  EXPECT_HAS(refusal([] {
               run({"haptic_rate_hz=100", "slave.mass_kg=1", "slave.contact_stiffness_N_per_m=4e5"});
             }),
             "slave.steps_per_tick = 10: expected more for this tool");
}

}  // namespace
}  // namespace remote_touch::steered_tool_test
