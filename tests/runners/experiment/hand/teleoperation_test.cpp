#include "runners/experiment/hand/teleoperation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch::teleoperation_test {
namespace {

// The remote side of a run: what is sent to the slave, what comes back, and when.

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
}

TEST(Teleoperation, TheCommandIsWhatIsSent) {
  RenderOutput out;
  out.slave_W = Vec3(1, 2, 3);
  const DeviceState device{{4, 5, 6}};
  EXPECT_EQ(Teleoperation(with(Feedback::rendered), {}, kTick_s, ground()).command(device, out), out.slave_W);
  for (const Feedback force : {Feedback::none, Feedback::slave_force, Feedback::passive_slave_force})
    EXPECT_EQ(Teleoperation(with(force), {}, kTick_s, ground()).command(device, out), device.position_W);
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

TEST(Teleoperation, WithoutFeedbackSendsTheHip) {
  const std::vector<Tick> ticks = descent(with(Feedback::none));
  for (const Tick& tick : ticks) EXPECT_EQ(tick.felt.force_N, Vec3::Zero());
  EXPECT_GT(ticks.back().slave.peak_force_N, 1);
  EXPECT_EQ(ticks.back().slave.force_packets, 0);
  EXPECT_EQ(ticks.back().slave.command_W.y(), -0.01);
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

// The command takes the delay and one tick, in which the slave moves to it. The force takes the delay.
TEST(Teleoperation, TheForceOfTheSlaveComesBackAfterTheDelays) {
  for (const int delay : {0, 30}) {
    const std::vector<Tick> ticks = descent(with(Feedback::slave_force, delay * kTick_s));
    for (int i = delay + 1; i < static_cast<int>(ticks.size()); ++i) {
      const auto now = static_cast<std::size_t>(i), sent = static_cast<std::size_t>(i - delay);
      EXPECT_EQ(ticks[now].felt.force_N, ticks[sent].slave.force_N) << delay << " " << i;
      const double command = std::max(-0.01, 0.02 - 0.05 * (i - 1 - delay) * kTick_s);
      EXPECT_EQ(ticks[now].slave.command_W.y(), command) << delay << " " << i;
    }
    EXPECT_GT(ticks.back().felt.force_N.y(), 1);
  }
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
    const Vec3 faded = descent(s, 3000).back().felt.force_N;
    s.feedback.hold.hold_s = 0;
    EXPECT_EQ(faded, descent(s, 3000).back().felt.force_N) << longest_s;
    EXPECT_GT(faded.norm(), 1);
  }
}

TEST(Teleoperation, TheGainScalesTheForceOfTheSlave) {
  TeleoperationSettings s = with(Feedback::slave_force);
  const Vec3 whole = descent(s).back().felt.force_N;
  s.feedback.gain = 0.25;
  EXPECT_NEAR((descent(s).back().felt.force_N - 0.25 * whole).norm(), 0, 1e-12);
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

TEST(Teleoperation, ADeadBandSavesPackets) {
  TeleoperationSettings s = with(Feedback::slave_force);
  const std::int32_t all = descent(s).back().slave.force_packets;
  s.forces.dead_band.weber_fraction = 0.1, s.forces.dead_band.least = 0.01;
  s.commands.dead_band.least = 1e-4;
  const SlaveState saved = descent(s).back().slave;
  EXPECT_EQ(all, 1500);
  EXPECT_LT(saved.force_packets, 200);
  EXPECT_GT(saved.force_packets, 5);
  // A command moves by 0.05 mm in a tick, so a packet is sent after the second or third tick.
  EXPECT_GE(saved.command_packets, 0.03 / 1.5e-4);
  EXPECT_LE(saved.command_packets, 0.03 / 1e-4 + 2);
}

// The motion of the hand is prescribed, so the controller predicts a tick by the one before. The balance
// falls below 0 by the errors of this prediction only.
TEST(Teleoperation, PassivityControlKeepsTheBalanceAtBothPorts) {
  for (const int delay : {0, 5, 50, 200}) {
    Teleoperation remote(with(Feedback::passive_slave_force, delay * kTick_s), {}, kTick_s, ground());
    double lowest = 0, felt = 0;
    for (int i = 0; i < 4000; ++i) {
      const double t = i * kTick_s, y = 0.003 + 0.012 * std::sin(7 * t) * std::sin(1.3 * t);
      felt = std::max(felt, remote.tick({{0, y, 0}}, {}, t).force_N.norm());
      lowest = std::min({lowest, remote.hand_energy().balance_J(), remote.slave_energy().balance_J()});
    }
    EXPECT_GT(felt, 0.3) << delay;
    EXPECT_GT(lowest, -2e-3) << delay;
    EXPECT_GT(remote.hand_energy().received_J, 0) << delay;
    EXPECT_GT(remote.hand_energy().dissipated_J, 0) << delay;
  }
}

// The link of frames: it judges a frame by where the slave was at its capture, and passes on what it sends.

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

TEST(FrameLink, PassesEveryFrameOnWithoutADeadBand) {
  Receiver receiver;
  FrameLink link({}, receiver, kernels_for(best_isa()));
  for (int i = 0; i < 3; ++i) link.on_frame(frame(0, 0.03 * i));
  EXPECT_EQ(receiver.frames.size(), 3u);
}

}  // namespace
}  // namespace remote_touch::teleoperation_test
