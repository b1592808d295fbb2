// The perceptual dead-band: the error of what the receiver shows, with losses, delays and turning tools.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/points/vector.h"
#include "core/teleoperation/channel.h"

namespace remote_touch::dead_band_error_test {
namespace {

constexpr double kTick_s = 0.001;
constexpr double kRounding = 1e-12;

// --- what is shown ---

// A force that wanders, and stops at times.
std::vector<Vec3> wandering(int ticks) {
  std::vector<Vec3> values;
  Vec3 value(1, 0, 0), speed = Vec3::Zero();
  for (int k = 0; k < ticks; ++k) {
    const auto u = uniforms(noise_stream({}, NoiseUse::motion, 0), static_cast<std::uint32_t>(k));
    speed = 0.99 * speed + 0.5 * Vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5);
    if (k % 1000 < 800) value += kTick_s * speed * 10;
    values.push_back(k % 3000 < 100 ? Vec3(Vec3::Zero()) : value);
  }
  return values;
}

TEST(DeadBand, BoundsTheErrorAtTheSender) {
  const std::vector<Vec3> force = wandering(20000);
  for (const double fraction : {0.0, 0.05, 0.2})
    for (const double least : {0.0, 0.1})
      for (const bool predicts : {false, true}) {
        DeadBandSender sender({fraction, least, predicts});
        for (int k = 0; k < 20000; ++k) {
          const bool is_sent = sender.send(force[k], k * kTick_s).has_value();
          const Vec3 shown = sender.shown(k * kTick_s).value();
          ASSERT_LE((force[k] - shown).norm(), std::max(fraction * shown.norm(), least)) << k;
          ASSERT_TRUE(!is_sent || shown == force[k]) << k;
        }
        EXPECT_TRUE(fraction == 0 || sender.packets() < sender.samples() / 2) << sender.packets();
      }
}

TEST(DeadBandReceiver, ShowsNothingBeforeTheFirstSample) {
  EXPECT_EQ(DeadBandReceiver().shown(1), std::nullopt);
  EXPECT_EQ(DeadBandSender({}).shown(1), std::nullopt);
}

TEST(DeadBandReceiver, ShowsTheValueOfTheSenderWithoutADelay) {
  const std::vector<Vec3> force = wandering(5000);
  for (const bool predicts : {false, true}) {
    DeadBandSender sender({.weber_fraction = 0.1, .predicts = predicts});
    DeadBandReceiver receiver;
    Channel<DeadBandSample> channel({}, {}, NoiseUse::force_channel);
    for (int k = 0; k < 5000; ++k) {
      const double time_s = k * kTick_s;
      if (const auto sample = sender.send(force[k], time_s)) channel.send(time_s, *sample);
      if (const auto sample = channel.receive(time_s)) receiver.receive(*sample, time_s);
      ASSERT_EQ(receiver.shown(time_s), sender.shown(time_s)) << k;
    }
  }
}

// After a constant delay the receiver shows what the sender showed then, and the dead-band bounds its error.
TEST(DeadBandReceiver, ShowsTheDelayedValueOfTheSender) {
  constexpr int kDelay = 150;
  const std::vector<Vec3> force = wandering(5000);
  for (const bool predicts : {false, true}) {
    DeadBandSender sender({.weber_fraction = 0.1, .predicts = predicts});
    DeadBandReceiver receiver;
    Channel<DeadBandSample> channel({.delay_s = kDelay * kTick_s}, {}, NoiseUse::force_channel);
    std::vector<Vec3> shown;
    for (int k = 0; k < 5000; ++k) {
      const double time_s = k * kTick_s;
      if (const auto sample = sender.send(force[k], time_s)) channel.send(time_s, *sample);
      shown.push_back(sender.shown(time_s).value());
      if (const auto sample = channel.receive(time_s)) receiver.receive(*sample, time_s);
      ASSERT_EQ(receiver.shown(time_s).has_value(), k >= kDelay);
      if (k < kDelay) continue;
      const Vec3 got = receiver.shown(time_s).value();
      ASSERT_NEAR((got - shown[k - kDelay]).norm(), 0, kRounding) << k;
      ASSERT_LE((got - force[k - kDelay]).norm(), 0.1 * got.norm() + kRounding);
    }
  }
}

// A lost packet has no effect after the next one has arrived.
TEST(DeadBandReceiver, NeedsNoEarlierPacket) {
  DeadBandSender sender({.weber_fraction = 0.05, .predicts = true});
  DeadBandReceiver complete, lossy;
  int packets = 0;
  for (int k = 0; k < 2000; ++k) {
    const double time_s = k * kTick_s;
    const auto sample = sender.send({2 + std::sin(5 * time_s), 0, 0}, time_s);
    if (!sample) continue;
    complete.receive(*sample, time_s);
    if (packets++ % 2 == 0) continue;
    lossy.receive(*sample, time_s);
    EXPECT_EQ(lossy.shown(time_s + 0.01), complete.shown(time_s + 0.01));
  }
  EXPECT_GT(packets, 4);
}

// --- poses ---

struct TestPose {
  Vec3 position;
  Eigen::Quaterniond orientation;
};

// A tool that wanders and turns; at times it only turns.
std::vector<TestPose> wandering_poses(int ticks) {
  const std::vector<Vec3> position = wandering(ticks);
  std::vector<TestPose> poses;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Vec3 turn = Vec3::Zero();
  for (int k = 0; k < ticks; ++k) {
    const auto u = uniforms(noise_stream({}, NoiseUse::motion, 1), static_cast<std::uint32_t>(k));
    turn = 0.99 * turn + 1e-4 * Vec3(u[0] - 0.5, u[1] - 0.5, u[2] - 0.5);
    q = (rotation(turn) * q).normalized();
    poses.push_back({0.1 * position[k % 2000 < 1000 ? k : k - k % 1000], q});
  }
  return poses;
}

// The oracle moves the points of a tool by both poses. The reach is the distance of the farthest one.
TEST(DeadBand, BoundsTheErrorAtEveryPointOfATool) {
  const std::vector<Vec3> points{{0.08, 0, 0}, {0, -0.06, 0.01}, {-0.02, 0.03, -0.07}, {0, 0, 0.05}};
  const std::vector<TestPose> poses = wandering_poses(20000);
  for (const double least_m : {0.0005, 0.005})
    for (const bool predicts : {false, true}) {
      DeadBandSender sender({.least = least_m, .predicts = predicts}, 0.08);
      DeadBandReceiver receiver;
      double largest_m = 0;
      for (int k = 0; k < 20000; ++k) {
        const TestPose& pose = poses[k];
        const double time_s = k * kTick_s;
        if (const auto sample = sender.send(pose.position, time_s, pose.orientation))
          receiver.receive(*sample, time_s);
        const Vec3 at = receiver.shown(time_s).value();
        const Eigen::Quaterniond turned = receiver.shown_orientation(time_s).value();
        for (const Vec3& p : points)
          largest_m = std::max(largest_m, (at + turned * p - pose.position - pose.orientation * p).norm());
      }
      EXPECT_LE(largest_m, least_m + kRounding);
      EXPECT_GT(largest_m, 0.5 * least_m);  // the bound is not far above
      EXPECT_LT(sender.packets(), sender.samples() / 2) << least_m << predicts;
    }
}

TEST(DeadBandReceiver, ShowsTheOrientationOfTheSender) {
  const std::vector<TestPose> poses = wandering_poses(3000);
  for (const bool predicts : {false, true}) {
    DeadBandSender sender({.least = 0.002, .predicts = predicts}, 0.08);
    DeadBandReceiver receiver;
    EXPECT_EQ(sender.shown_orientation(0).has_value(), false);
    EXPECT_EQ(receiver.shown_orientation(0).has_value(), false);
    for (int k = 0; k < 3000; ++k) {
      const double time_s = k * kTick_s;
      const auto sample = sender.send(poses[k].position, time_s, poses[k].orientation);
      if (sample) receiver.receive(*sample, time_s);
      ASSERT_TRUE(!sample || sample->orientation_W.coeffs() == poses[k].orientation.coeffs()) << k;
      const Eigen::Quaterniond got = receiver.shown_orientation(time_s).value();
      ASSERT_EQ(got.coeffs(), sender.shown_orientation(time_s).value().coeffs()) << k;
      ASSERT_NEAR(got.norm(), 1, kRounding);
    }
  }
}

// --- silence ---

// The packet that ends a ramp is lost. The prediction then goes on, until the silence is broken.
TEST(DeadBand, BoundsTheEffectOfALossByItsSilence) {
  for (const double silence_s : {0.0, 0.1}) {
    DeadBandSender sender({.weber_fraction = 0.05, .predicts = true, .longest_silence_s = silence_s});
    DeadBandReceiver receiver;
    double shown = 0, sent_after = 0;
    for (int k = 0; k < 1000; ++k) {
      const double time_s = k * kTick_s;
      const auto sample = sender.send({std::min(1 + 0.01 * k, 5.0), 0, 0}, time_s);
      const bool is_lost = k > 400 && sent_after < 2;  // the value that ends the ramp, and its slope
      if (sample && k > 400) ++sent_after;
      if (sample && !is_lost) receiver.receive(*sample, time_s);
      shown = receiver.shown(time_s).value().x();
    }
    if (silence_s > 0)
      EXPECT_NEAR(shown, 5, 0.05 * 5);
    else
      EXPECT_GT(shown, 10) << "no packet follows";
  }
}

}  // namespace
}  // namespace remote_touch::dead_band_error_test
