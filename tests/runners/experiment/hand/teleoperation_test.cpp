// The remote side of a run: what is sent to a slave, with or without a tool, what comes back, and when.
#include "runners/experiment/hand/teleoperation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::teleoperation_test {
namespace {

constexpr double kTick_s = 0.001;

// The ground is the plane y = 0.
SlaveScene ground() {
  return {[](const Vec3& p, double) { return p.y(); }, [](const Vec3&, double) { return Vec3(0, 1, 0); }};
}

struct Tick {
  SlaveState slave;
  Wrench felt;
};

// The hand moves down from 2 cm and presses 1 cm below the ground; the renderer commands a position that
// stays above it, with a force of its own.
std::vector<Tick> descent(const TeleoperationSettings& settings, int ticks = 1500) {
  Teleoperation remote(settings, {}, kTick_s, ground());
  std::vector<Tick> list;
  for (int i = 0; i < ticks; ++i) {
    const double y = std::max(-0.01, 0.02 - 0.05 * i * kTick_s);
    RenderOutput out;
    out.slave_W = Vec3(0, std::max(y, 0.006), 0);
    out.force_N = Vec3(0, y < 0.006 ? 3 : 0, 0);
    list.push_back({});
    list.back().felt = remote.tick({{0, y, 0}}, out, i * kTick_s);
    list.back().slave = remote.state();
  }
  return list;
}

TeleoperationSettings with(Feedback force, double delay_s = 0) {
  TeleoperationSettings s;
  s.feedback.force = force;
  s.commands.channel.delay_s = s.forces.channel.delay_s = delay_s;
  return s;
}

// A tool of one point, 3 cm beside its centre of mass and 1 cm below.
TeleoperationSettings with_tool(Feedback force, int delay_ticks = 0) {
  TeleoperationSettings s = with(force, delay_ticks * kTick_s);
  s.tool = SlaveTool{{{0.03, -0.01, 0}}, {1e-4}, 0.02, 0.04};
  return s;
}

DeviceState device(double y, const Vec3& turn) {
  DeviceState d;
  d.position_W = Vec3(0, y, 0), d.orientation_W = rotation(turn);
  return d;
}

TEST(Teleoperation, RendersAndSendsTheCommandOfTheRenderer) {
  const std::vector<Tick> ticks = descent(with(Feedback::rendered));
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double y = 0.02 - 0.05 * static_cast<double>(i) * kTick_s;
    EXPECT_EQ(ticks[i].felt.force_N, Vec3(0, y < 0.006 ? 3 : 0, 0)) << i;
    EXPECT_EQ(ticks[i].slave.peak_force_N, 0) << i;
    EXPECT_EQ(ticks[i].slave.force_packets, 0) << i;
    EXPECT_EQ(ticks[i].slave.command_packets, static_cast<std::int32_t>(i) + 1) << i;
  }
  EXPECT_NEAR(ticks.back().slave.position_W.y(), 0.006, 1e-4);
  const std::vector<Tick> unfelt = descent(with(Feedback::none));
  for (const Tick& tick : unfelt) EXPECT_EQ(tick.felt.force_N, Vec3::Zero());
  EXPECT_GT(unfelt.back().slave.peak_force_N, 1);
  EXPECT_EQ(unfelt.back().slave.force_packets, 0);
}

// The command is that of the renderer, or the hand itself: without a rendered force, and in a renderer with
// slave_command = hip.
TEST(Teleoperation, TheCommandIsWhatIsSent) {
  RenderOutput out;
  out.tool.emplace().orientation_W = rotation({0, 1, 0});
  out.proxy_W = out.slave_W = Vec3(1, 2, 3);
  const DeviceState hand = device(0.5, {1, 0, 0});
  const Teleoperation rendered(with_tool(Feedback::rendered), {}, kTick_s, ground());
  EXPECT_EQ(rendered.command(hand, out), out.slave_W);
  EXPECT_EQ(rendered.command_orientation(hand, out).coeffs(), out.tool->orientation_W.coeffs());
  for (const Feedback force : {Feedback::none, Feedback::slave_force, Feedback::passive_slave_force}) {
    const Teleoperation direct(with_tool(force), {}, kTick_s, ground());
    EXPECT_EQ(direct.command(hand, out), hand.position_W);
    EXPECT_EQ(direct.command_orientation(hand, out).coeffs(), hand.orientation_W.coeffs());
  }
  out.slave_W = hand.position_W;
  EXPECT_EQ(rendered.command_orientation(hand, out).coeffs(), hand.orientation_W.coeffs());
}

// The command takes the delay and one tick, in which the slave moves to it. The force takes the delay.
TEST(Teleoperation, TheForceOfTheSlaveComesBackAfterTheDelays) {
  for (const bool has_tool : {false, true})
    for (const int delay : {0, 30}) {
      TeleoperationSettings s = with_tool(Feedback::slave_force, delay);
      if (!has_tool) s.tool.reset();
      s.feedback.gain = 0.5;
      Teleoperation remote(s, {}, kTick_s, ground());
      std::vector<SlaveState> states;
      const auto height = [](int tick) { return std::max(0.02 - 0.05 * tick * kTick_s, -0.01); };
      for (int i = 0; i < 1500; ++i) {
        const Wrench felt = remote.tick(device(height(i), Vec3::Zero()), {}, i * kTick_s);
        states.push_back(remote.state());
        if (i <= delay) continue;
        const SlaveState& sent = states[static_cast<std::size_t>(i - delay)];
        ASSERT_EQ(states.back().command_W.y(), height(i - 1 - delay)) << has_tool << " " << delay << " " << i;
        ASSERT_EQ(felt.force_N, 0.5 * sent.force_N) << has_tool << " " << delay << " " << i;
        ASSERT_EQ(felt.torque_Nm, has_tool ? Vec3(0.5 * sent.tool->torque_Nm) : Vec3(Vec3::Zero())) << i;
      }
      EXPECT_GT(states.back().force_N.y(), 1) << has_tool << " " << delay;
      // The arm is along x, the force along y.
      EXPECT_TRUE(!has_tool || states.back().tool->torque_Nm.z() > 0.02) << delay;
    }
}

// An unknown force is not shown as zero, but the hand feels no NaN.
TEST(Teleoperation, AForceWithoutANormalIsNotKnown) {
  SlaveScene scene = ground();
  scene.normal = [](const Vec3&, double) { return Vec3(Vec3::Constant(std::nan(""))); };
  Teleoperation remote(with(Feedback::slave_force), {}, kTick_s, scene);
  for (int i = 0; i < 600; ++i)
    EXPECT_EQ(remote.tick({{0, i < 300 ? 0.01 : -0.01, 0}}, {}, i * kTick_s).force_N, Vec3::Zero());
  EXPECT_LT(remote.state().clearance_m, 0);
  EXPECT_TRUE(std::isnan(remote.state().peak_force_N));
  EXPECT_TRUE(remote.state().force_N.hasNaN());
}

// The slave goes where the wrong registration sends it; what the hand feels is turned back.
TEST(Teleoperation, TheRegistrationMovesTheSlaveAndTurnsItsForce) {
  TeleoperationSettings s = with(Feedback::slave_force);
  s.registration = {0.003, 10};
  const RigidTransform X = registration_of(s.registration, {});
  const std::vector<Tick> ticks = descent(s);
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const Vec3 sent(0, std::max(-0.01, 0.02 - 0.05 * static_cast<double>(i - 1) * kTick_s), 0);
    EXPECT_NEAR((ticks[i].slave.command_W - X * sent).norm(), 0, 1e-15) << i;
    EXPECT_NEAR((ticks[i].felt.force_N - X.linear().transpose() * ticks[i].slave.force_N).norm(), 0, 1e-12)
        << i;
  }
  EXPECT_GT(ticks.back().felt.force_N.norm(), 1);
  EXPECT_NEAR(ticks.back().slave.force_N.normalized().y(), 1, 1e-12);  // the ground is where it was
}

// The packets of the force are lost in bursts. The fates of the packets are known, so each tick tells when
// the last one arrived. With hold_s = 0 the force is held, as long as it takes.
TEST(Teleoperation, AForceWhosePacketsAreLostFadesToZero) {
  TeleoperationSettings s = with(Feedback::slave_force);
  s.forces.channel.loss_probability = 0.9, s.forces.channel.mean_burst_packets = 300;
  for (const HoldSettings hold : {HoldSettings{}, HoldSettings{0.01, 0}, HoldSettings{0, 0.02}}) {
    s.feedback.hold = hold;
    PacketFates fates(s.forces.channel, {}, NoiseUse::force_channel);
    const std::vector<Tick> ticks = descent(s, 6000);
    Vec3 arrived = Vec3::Zero();
    int silent = 0, faded = 0;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      ++silent;
      if (!fates.next().is_lost) arrived = ticks[i].slave.force_N, silent = 0;
      const double share = hold.hold_s == 0 || silent * kTick_s <= hold.hold_s + 1e-9 ? 1
                           : silent * kTick_s >= hold.hold_s + hold.fade_s - 1e-9
                               ? 0
                               : (hold.hold_s + hold.fade_s - silent * kTick_s) / hold.fade_s;
      EXPECT_NEAR((ticks[i].felt.force_N - share * arrived).norm(), 0, 1e-9) << i;
      faded += share == 0 && arrived.norm() > 1;
    }
    EXPECT_EQ(faded > 0, hold.hold_s > 0);
  }
}

// A dead-band sends nothing while the force is constant: silence is no loss, unless a limit of silence has
// passed.
TEST(Teleoperation, ASilentDeadBandIsNoLoss) {
  TeleoperationSettings s = with(Feedback::slave_force);
  s.forces.dead_band.weber_fraction = 0.1, s.forces.dead_band.least = 0.01;
  for (const double longest_s : {0.0, 0.2}) {
    s.forces.dead_band.longest_silence_s = longest_s;
    s.feedback.hold.hold_s = 0.05;
    const Tick last = descent(s, 3000).back();
    const Vec3 faded = last.felt.force_N;
    EXPECT_LT(last.slave.force_packets, 200);
    EXPECT_GT(last.slave.force_packets, 5);
    s.feedback.hold.hold_s = 0;
    EXPECT_EQ(faded, descent(s, 3000).back().felt.force_N) << longest_s;
    EXPECT_GT(faded.norm(), 1);
  }
}

// A slave waits for the first command that is finite, and starts there at rest, whatever the delay.
TEST(Teleoperation, TheSlaveStartsAtTheFirstCommand) {
  Teleoperation remote(with(Feedback::rendered, 0.1), {}, kTick_s, ground());
  RenderOutput out;  // its command is NaN
  remote.tick({}, out, 0);
  EXPECT_TRUE(std::isnan(remote.state().position_W.x()));
  out.slave_W = Vec3(1, 2, 3);
  remote.tick({}, out, kTick_s);
  EXPECT_EQ(remote.state().position_W, Vec3(1, 2, 3));
  EXPECT_NEAR(remote.state().clearance_m, 1.995, 1e-12);
  out.slave_W = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  remote.tick({}, out, 2 * kTick_s);
  EXPECT_EQ(remote.state().command_packets, 1);
  EXPECT_EQ(remote.state().position_W, Vec3(1, 2, 3));
}

// The slave follows a command that arrives in the middle of the ticks that are missing.
TEST(Teleoperation, TheSlaveMovesInTicksThatAreLeftOut) {
  const auto run = [](bool leaves_out) {
    Teleoperation remote(with(Feedback::slave_force, 0.005), {}, kTick_s, ground());
    double peak_N = 0;
    for (int i = 0; i <= 400; ++i) {
      if (leaves_out && i > 100 && i <= 120) continue;
      const double y = i < 100 ? 0.0052 : -0.01;
      remote.tick({{0, y, 0}}, {}, i * kTick_s);
      peak_N = std::max(peak_N, remote.state().peak_force_N);
    }
    SlaveState end = remote.state();
    end.peak_force_N = peak_N;
    return end;
  };
  const SlaveState all = run(false), some = run(true);
  EXPECT_NEAR((some.position_W - all.position_W).norm(), 0, 1e-9);
  EXPECT_NEAR((some.force_N - all.force_N).norm(), 0, 1e-6);
  EXPECT_GT(all.peak_force_N, all.force_N.norm() + 1) << "the impact, which is in the ticks that are missing";
  EXPECT_NEAR(some.peak_force_N, all.peak_force_N, 1e-6);
  EXPECT_EQ(some.force_packets, all.force_packets);
  EXPECT_EQ(some.command_packets, all.command_packets - 20);
}

// The surface is elsewhere after a pause longer than kMaxMissedTicks. Its motion in the pause is no approach.
TEST(Teleoperation, TheSlaveStandsStillInTheFirstPartOfALongPause) {
  TeleoperationSettings s = with(Feedback::none);
  s.slave.natural_frequency_hz = 0.1;
  const SlaveScene rising{[](const Vec3& p, double time_s) { return p.y() - 0.01 * time_s; },
                          [](const Vec3&, double) { return Vec3(0, 1, 0); }};
  Teleoperation remote(s, {}, kTick_s, rising);
  remote.tick({{0, 0.105, 0}}, {}, 0);
  remote.tick({{0, 0.105, 0}}, {}, 10.121);  // the surface is 1 mm inside the ball when it moves again
  EXPECT_NEAR(remote.state().peak_force_N, 0.001 * s.slave.contact_stiffness_N_per_m, 1);
  EXPECT_GT(remote.state().position_W.y(), 0.107);
}

// A device with a fault reports NaN for some ticks. The motion of the hand meanwhile counts in the tick
// after.
TEST(Teleoperation, AHandWithoutAPositionLeavesNoTrace) {
  Teleoperation remote(with(Feedback::passive_slave_force, 0.005), {}, kTick_s, ground());
  double felt_N = 0;
  for (int i = 0; i < 2000; ++i) {
    const double y = i >= 200 && i < 210 ? std::numeric_limits<double>::quiet_NaN() : 0.02 - 2e-5 * i;
    const Wrench felt = remote.tick({{0, y, 0}}, {}, i * kTick_s);
    ASSERT_TRUE(felt.force_N.allFinite()) << i;
    felt_N = std::max(felt_N, felt.force_N.norm());
  }
  EXPECT_TRUE(remote.state().position_W.allFinite());
  EXPECT_TRUE(std::isfinite(remote.hand_energy().balance_J()));
  EXPECT_GT(felt_N, 0.3);
}

// The hand at rest 1 cm below the ground commands the ball, of 5 mm, 1.5 cm beyond the first contact.
TEST(Teleoperation, TheStiffnessIsThatOfDriveAndContactInSeries) {
  TeleoperationSettings s = with(Feedback::slave_force);
  s.feedback.gain = 0.5;
  EXPECT_NEAR(descent(s, 3000).back().felt.force_N.y(), 0.015 * felt_stiffness_N_per_m(s.slave, s.feedback),
              1e-3);
  s.feedback.force = Feedback::none;
  EXPECT_EQ(felt_stiffness_N_per_m(s.slave, s.feedback), 0);
}

// --- a slave with a tool: orientations that are sent, and torques that come back ---

TEST(SteeredTool, TheOrientationTravelsWithTheCommand) {
  for (const int delay : {0, 30}) {
    TeleoperationSettings s = with_tool(Feedback::none, delay);
    s.slave.natural_frequency_hz = 20;
    Teleoperation remote(s, {}, kTick_s, ground());
    double largest = 0;
    for (int i = 0; i < 1500; ++i) {
      const double t = i * kTick_s;
      remote.tick(device(1, {0, 0, 0.5 * t}), {}, t);
      const double late = t - (delay + 1) * kTick_s;  // time of the command that the slave has reached
      const double lag = remote.state().tool->orientation_W.angularDistance(rotation({0, 0, 0.5 * late}));
      if (i > 1000) largest = std::max(largest, lag);
    }
    EXPECT_LT(largest, 1e-4) << delay;  // the drive knows the speed of the command
  }
}

TEST(SteeredTool, WaitsForACommandWithAnOrientation) {
  Teleoperation remote(with_tool(Feedback::none), {}, kTick_s, ground());
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

TEST(SteeredTool, RefusesTooFewStepsOfATick) {
  EXPECT_HAS(refusal([] {
               run({"haptic_rate_hz=100", "slave.mass_kg=1", "slave.contact_stiffness_N_per_m=4e5"});
             }),
             "slave.steps_per_tick = 10: expected more for this tool");
}

// --- the link of frames ---

class Receiver final : public FrameReceiver {
 public:
  void on_frame(const Frame& frame) override { frames.push_back(frame.index); }
  std::vector<int> frames;
};

// A plane over x < 0 at rest and one over x > 0 that rises by 3 mm a frame, 4 mm between the points.
Frame frame(int index, double captured_s) {
  PointCloud cloud;
  for (int i = -20; i < 20; ++i)
    for (int k = -10; k < 10; ++k) {
      cloud.x.push_back(0.004 * i + 0.002), cloud.z.push_back(0.004 * k);
      cloud.y.push_back(i < 0 ? 0 : 0.003 * index);
    }
  Frame made;
  made.index = index, made.captured_s = captured_s, made.points = make_search(std::move(cloud));
  return made;
}

TEST(FrameLink, JudgesByWhereTheSlaveWasWhenTheFrameWasCaptured) {
  Receiver receiver;
  FrameLink link({.least_motion_m = 0.001, .near_m = 0.02}, receiver, kernels_for(best_isa()));
  // The slave is over the part at rest until 0.1 s, and then over the part that rises.
  for (int tick = 0; tick < 200; ++tick)
    link.observe_slave(Vec3(tick < 100 ? -0.04 : 0.04, 0, 0), 0.001 * tick);
  for (int i = 0; i < 6; ++i) link.on_frame(frame(i, 0.03 * i));
  EXPECT_EQ(receiver.frames, (std::vector<int>{0, 4, 5}));
  EXPECT_EQ(link.sent(), 3);
}

// Before the slave starts its position is NaN, and frames are sent. With jitter some frames overtake others:
// they show nothing new, because the surface is at rest.
TEST(FrameLink, SendsNothingTwiceIfFramesOvertakeEachOther) {
  Receiver receiver;
  FrameLink link({.least_motion_m = 0.5, .near_m = 0.02}, receiver, kernels_for(best_isa()));
  link.observe_slave(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()), 0);
  link.on_frame(frame(0, 0));
  link.on_frame(frame(0, 0.001));
  for (int tick = 2; tick < 1000; ++tick) link.observe_slave(Vec3(-0.04, 0, 0), 0.001 * tick);
  for (int i = 1; i < 10; ++i)
    for (const int late : {0, 2, 1}) link.on_frame(frame(0, 0.1 * i - 0.03 * late));
  EXPECT_EQ(link.sent(), 2);
}

}  // namespace
}  // namespace remote_touch::teleoperation_test
