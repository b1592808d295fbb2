// The perceptual dead-band: the packets that are sent, against a search in the list of all values, the error
// of what the receiver shows, and the frames that are sent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "core/points/noise.h"
#include "core/points/vector.h"
#include "core/teleoperation/channel.h"
#include "tests/support/scenes.h"

namespace remote_touch::dead_band_test {
namespace {

constexpr double kTick_s = 0.001;
constexpr double kRounding = 1e-12;

using Signal = std::function<Vec3(int tick)>;

// Returns the ticks at which a packet is sent.
std::vector<int> sent_ticks(const DeadBandSettings& s, int ticks, const Signal& signal) {
  DeadBandSender sender(s);
  std::vector<int> sent;
  for (int k = 0; k < ticks; ++k)
    if (sender.send(signal(k), k * kTick_s)) sent.push_back(k);
  EXPECT_EQ(sender.samples(), static_cast<std::uint64_t>(ticks));
  EXPECT_EQ(sender.packets(), sent.size());
  return sent;
}

std::vector<int> multiples(int step, int end) {
  std::vector<int> list;
  for (int k = 0; k < end; k += step) list.push_back(k);
  return list;
}

TEST(DeadBandSettings, RefusesAFractionThatHidesTheEndOfAForce) {
  EXPECT_EQ(validate(DeadBandSettings{}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 0.999}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 1}),
            "weber_fraction = 1.000000: expected less than 1");
}

// The difference must exceed the threshold: a ramp of one quantum per tick and a threshold of five, all exact
// in binary.
TEST(DeadBand, SendsEverySampleByDefaultAndARampAtEqualSteps) {
  const Signal ramp = [](int k) { return Vec3(0, k * 0x1p-10, 0); };
  EXPECT_EQ(sent_ticks({.least = 5 * 0x1p-10}, 100, ramp), multiples(6, 100));
  EXPECT_EQ(sent_ticks({.least = 5 * 0x1p-10, .predicts = true}, 100, ramp), (std::vector<int>{0, 6}));
  for (const bool predicts : {false, true})
    EXPECT_EQ(sent_ticks({.predicts = predicts}, 100, [](int) { return Vec3(1, 2, 3); }), multiples(1, 100));
}

// The oracle searches the next packet after each one.
std::vector<int> searched_ticks(const DeadBandSettings& s, int ticks, const Signal& signal) {
  std::vector<int> sent{0};
  for (int k = 1; k < ticks; ++k) {
    const int last = sent.back();
    Vec3 shown = signal(last);
    if (s.predicts && sent.size() > 1) {
      const int before = sent[sent.size() - 2];
      shown += double(k - last) / (last - before) * (signal(last) - signal(before));
    }
    if ((signal(k) - shown).norm() > std::max(s.weber_fraction * shown.norm(), s.least)) sent.push_back(k);
  }
  return sent;
}

// Sines, a constant, a force that ends, growth at equal ratios, and a vector that turns by a degree a tick.
TEST(DeadBand, SendsWhatASearchFinds) {
  const auto wave = [](double bias, double rate_hz) {
    return [=](int k) { return Vec3(0, bias + std::sin(2 * std::numbers::pi * rate_hz * k * kTick_s), 0); };
  };
  const std::vector<Signal> signals{wave(0, 1),
                                    wave(3, 2),
                                    wave(1.5, 0.7),
                                    [](int) { return Vec3(1, 2, 3); },
                                    [](int k) { return Vec3(k == 0 ? 2 : 0, 0, 0); },
                                    [](int k) { return Vec3(0, 0, std::pow(1.01, k % 100)); },
                                    [](int k) {
                                      const double angle = k * std::numbers::pi / 180;
                                      return Vec3(3 * std::cos(angle), 0, 3 * std::sin(angle));
                                    }};
  constexpr int kTicks = 3000;
  for (std::size_t i = 0; i < signals.size(); ++i)
    for (const double fraction : {0.0, 0.05, 0.2, 0.999})
      for (const double least : {0.0, 0.3})
        for (const bool predicts : {false, true}) {
          if (fraction == 0 && least == 0) continue;
          const DeadBandSettings s{.weber_fraction = fraction, .least = least, .predicts = predicts};
          const std::vector<int> sent = sent_ticks(s, kTicks, signals[i]);
          EXPECT_EQ(sent, searched_ticks(s, kTicks, signals[i])) << i << " " << fraction << " " << least;
          EXPECT_LT(sent.size(), kTicks / 2u) << i << " " << fraction << " " << least;
        }
}

TEST(DeadBand, PredictsNothingFromTwoPacketsAtTheSameTime) {
  DeadBandSender sender({.predicts = true});
  sender.send({1, 0, 0}, 1);
  const auto sample = sender.send({2, 0, 0}, 1);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->slope_per_s, Vec3::Zero());
}

// 1 mrad in a tick moves the farthest point by 0.1 mm.
TEST(DeadBand, SendsARotationAloneByTheArcOfTheFarthestPoint) {
  const auto sent = [](double reach_m, bool predicts) {
    DeadBandSender sender({.least = 5.5e-4, .predicts = predicts}, reach_m);
    std::vector<int> ticks;
    for (int k = 0; k < 100; ++k)
      if (sender.send({1, 2, 3}, k * kTick_s, rotation({0, 1e-3 * k, 0}))) ticks.push_back(k);
    return ticks;
  };
  EXPECT_EQ(sent(0.1, false), multiples(6, 100));
  EXPECT_EQ(sent(0.1, true), (std::vector<int>{0, 6}));
  EXPECT_EQ(sent(0, false), (std::vector<int>{0}));
}

TEST(DeadBand, BreaksItsSilence) {
  for (const double fraction : {0.05, 0.2})
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction, .longest_silence_s = 0.05}, 1000,
                         [](int) { return Vec3(1, 2, 3); }),
              multiples(50, 1000));
}

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

// The receiver shows what the sender showed one delay before, and the dead-band bounds its error.
TEST(DeadBandReceiver, ShowsTheDelayedPoseOfTheSender) {
  constexpr double kReach_m = 0.08;
  const std::vector<TestPose> poses = wandering_poses(5000);
  for (const int delay : {0, 150})
    for (const bool predicts : {false, true}) {
      const DeadBandSettings s{.weber_fraction = 0.1, .least = 0.002, .predicts = predicts};
      DeadBandSender sender(s, kReach_m);
      DeadBandReceiver receiver;
      Channel<DeadBandSample> channel({.delay_s = delay * kTick_s}, {}, NoiseUse::force_channel);
      std::vector<TestPose> shown;
      for (int k = 0; k < 5000; ++k) {
        const double time_s = k * kTick_s;
        if (const auto sample = sender.send(poses[k].position, time_s, poses[k].orientation))
          channel.send(time_s, *sample);
        shown.push_back({sender.shown(time_s).value(), sender.shown_orientation(time_s).value()});
        if (const auto sample = channel.receive(time_s)) receiver.receive(*sample, time_s);
        ASSERT_EQ(receiver.shown(time_s).has_value(), k >= delay);
        ASSERT_EQ(receiver.shown_orientation(time_s).has_value(), k >= delay);
        if (k < delay) continue;
        const Vec3 at = receiver.shown(time_s).value();
        const Eigen::Quaterniond turned = receiver.shown_orientation(time_s).value();
        const TestPose &then = shown[k - delay], &was = poses[k - delay];
        ASSERT_NEAR((at - then.position).norm(), 0, kRounding) << k;
        ASSERT_NEAR((turned.coeffs() - then.orientation.coeffs()).norm(), 0, kRounding) << k;
        const double error_m =
            (at - was.position).norm() + kReach_m * turned.angularDistance(was.orientation);
        ASSERT_LE(error_m, std::max(0.1 * at.norm(), 0.002) + 1e-9) << k;
      }
      EXPECT_LT(sender.packets(), sender.samples() / 2);
    }
}

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

// --- frames: closed forms on planes, with noise, and what is seen by one frame only ---

using scenes::kernels;
using Points = std::shared_ptr<const NeighbourSearch>;

// A frame that was captured at 1 s times its number.
Frame frame(Points points, int number) {
  Frame made;
  made.index = number, made.captured_s = number, made.points = std::move(points);
  return made;
}

// A plane of 41 x 41 points, 2 mm apart, at a height and with a slope along x; noise_m: of the heights.
Points plane(double height_m, double slope = 0, double noise_m = 0, std::uint32_t frame = 0) {
  PointCloud cloud;
  const NoiseStream stream = noise_stream({}, NoiseUse::point_position, frame);
  for (int i = 0; i < 41; ++i)
    for (int k = 0; k < 41; ++k) {
      const double x = 0.002 * (i - 20), z = 0.002 * (k - 20);
      // A sum of four uniforms has the variance 1 / 3.
      const auto u = uniforms(stream, static_cast<std::uint32_t>(41 * i + k));
      const double normal = (u[0] + u[1] + u[2] + u[3] - 2) * std::sqrt(3.0);
      cloud.x.push_back(x), cloud.y.push_back(height_m + slope * x + noise_m * normal), cloud.z.push_back(z);
    }
  return make_search(std::move(cloud));
}

// A plane at rest whose points have regions, and those with an odd number a stiffness; NaN: none.
Points with_values(double radius_m, double stiffness_N_per_m = std::nan(""), int points = 41) {
  PointCloud cloud;
  for (int i = 0; i < points; ++i)
    for (int k = 0; k < 41; ++k) {
      cloud.append({0.002 * (i - 20), 0, 0.002 * (k - 20)});
      cloud.fixture_radius_m.push_back(radius_m);
      cloud.stiffness_N_per_m.push_back(k % 2 == 1 ? stiffness_N_per_m : std::nan(""));
    }
  return make_search(std::move(cloud));
}

Points nothing() {
  return make_search(PointCloud{});
}

double motion(const Points& before, const Points& now, const Vec3& slave = Vec3(0, 0.01, 0)) {
  return surface_motion_m(*before, *now, slave, 0.02, kernels());
}

// The disc is on the plane before, around the point of it that is nearest to the slave.
TEST(SurfaceMotion, IsTheLargestOnTheDiscIfThePlaneTurns) {
  const Vec3 slave(0, 0.01, 0);
  for (const double before : {0.0, 0.2, -0.4})
    for (const double now : {0.0, 0.2, -0.4, 0.36})
      for (const double lift : {0.0, 0.003, -0.003}) {
        const Vec3 normal = Vec3(-before, 1, 0).normalized(), along = Vec3(1, before, 0).normalized();
        const Vec3 foot = slave - normal.dot(slave) * normal;
        double largest = 0;
        for (const double r : {-0.02, 0.02}) {
          const Vec3 p = foot + r * along;  // the plane now is y = lift + now x, along the normal before
          largest =
              std::max(largest, std::abs((lift + now * p.x() - p.y()) / (normal.y() - now * normal.x())));
        }
        EXPECT_NEAR(motion(plane(0, before), plane(lift, now), slave), largest, 1e-12)
            << before << " " << now << " " << lift;
      }
}

TEST(SurfaceMotion, DoesNotDependOnTheAxes) {
  const auto turned = [](const Points& points, const RigidTransform& X) {
    PointCloud cloud, buffer;
    cloud = points->every_point(kernels(), buffer);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p = X * cloud.point(i);
      cloud.x[i] = p.x(), cloud.y[i] = p.y(), cloud.z[i] = p.z();
    }
    return make_search(std::move(cloud));
  };
  RigidTransform X = RigidTransform::Identity();
  X.linear() = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  X.translation() = Vec3(0.3, -0.1, 0.8);
  const Points before = plane(0, 0.1, 0.0005, 1), now = plane(0.002, -0.2, 0.0005, 2);
  const Vec3 slave(0.005, 0.01, -0.003);
  EXPECT_NEAR(motion(turned(before, X), turned(now, X), X * slave), motion(before, now, slave), 1e-12);
}

// Noise is averaged over N = 1257 points with the weights w: the height has the standard deviation
// 2^(1/2) 1 mm (sum w^2)^(1/2) / sum w = 0.053 mm, and the plane, at the rim and in each direction, 0.124 mm.
// The limit is four times both.
TEST(SurfaceMotion, AveragesNoise) {
  const auto noisy = [](double height_m, std::uint32_t frame) { return plane(height_m, 0, 0.001, frame); };
  const auto motion_in_40_mm = [](const Points& before, const Points& now) {
    return surface_motion_m(*before, *now, Vec3(0, 0.01, 0), 0.04, kernels());
  };
  for (std::uint32_t frame = 1; frame < 20; ++frame) {
    EXPECT_LT(motion_in_40_mm(noisy(0, 0), noisy(0, frame)), 0.0007) << frame;
    EXPECT_NEAR(motion_in_40_mm(noisy(0, 0), noisy(0.002, frame)), 0.002, 0.0007) << frame;
  }
}

TEST(SurfaceMotion, IsInfiniteWhereOnlyOneFrameHasASurface) {
  EXPECT_EQ(motion(plane(0), nothing()), std::numeric_limits<double>::infinity());
  EXPECT_EQ(motion(nothing(), plane(0)), std::numeric_limits<double>::infinity());
  EXPECT_EQ(motion(nothing(), nothing()), 0);
  EXPECT_EQ(motion(plane(0), plane(0.001), Vec3(0, 1, 0)), 0);  // far away from both
}

TEST(FrameDeadBand, SendsWhenTheSurfaceIsAwayFromTheLastThatWasSent) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  const Vec3 slave(0, 0.01, 0);
  std::vector<int> sent;
  for (int i = 0; i <= 30; ++i)  // rises by 0.3 mm a frame
    if (band.sends(frame(plane(0.0003 * i), i), slave, kernels())) sent.push_back(i);
  EXPECT_EQ(sent, (std::vector<int>{0, 4, 8, 12, 16, 20, 24, 28}));
  EXPECT_EQ(band.sent(), 8);
  EXPECT_TRUE(band.sends(frame(nothing(), 31), slave, kernels()));
}

TEST(FrameDeadBand, SendsAllWithoutABandAndBeforeTheSlaveStarts) {
  FrameDeadBand none({});
  FrameDeadBand wide({.least_motion_m = 1});
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(none.sends(frame(plane(0), i), Vec3::Zero(), kernels()));
    EXPECT_TRUE(wide.sends(frame(plane(0), i), std::nullopt, kernels()));
  }
  EXPECT_FALSE(wide.sends(frame(plane(0.01), 3), Vec3::Zero(), kernels()));
  EXPECT_EQ(none.sent(), 3);
  EXPECT_EQ(wide.sent(), 3);
}

// A region that is locked, a ramp and a schedule of stiffness reach the renderer though no surface moves.
TEST(FrameDeadBand, SendsWhenRegionsOrStiffnessChange) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  int number = 0;
  const auto sends = [&](Points points) {
    return band.sends(frame(std::move(points), number++), Vec3(0, 0.01, 0), kernels());
  };
  EXPECT_TRUE(sends(plane(0)));
  EXPECT_FALSE(sends(with_values(0))) << "a radius of 0 is no region";
  EXPECT_TRUE(sends(with_values(0.02)));
  EXPECT_FALSE(sends(with_values(0.02)));
  EXPECT_TRUE(sends(with_values(0.02 + 1e-9)));
  EXPECT_TRUE(sends(with_values(0.02 + 1e-9, 500)));
  EXPECT_FALSE(sends(with_values(0.02 + 1e-9, 500)));
  EXPECT_TRUE(sends(with_values(0.02 + 1e-9, 600)));
  EXPECT_TRUE(sends(with_values(0.02)));
  EXPECT_FALSE(sends(with_values(0.02, std::nan(""), 40))) << "all points of both have the same values";
  EXPECT_TRUE(sends(with_values(0.03, std::nan(""), 41)));
  EXPECT_TRUE(sends(plane(0)));
}

TEST(FrameDeadBand, SendsWhenAGuidanceTargetChanges) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  Frame now = frame(plane(0), 0);
  now.guidance.resize(1);
  EXPECT_TRUE(band.sends(now, Vec3::Zero(), kernels()));
  now.captured_s = 1;
  EXPECT_FALSE(band.sends(now, Vec3::Zero(), kernels()));
  now.guidance[0].strength = 0.5, now.captured_s = 2;
  EXPECT_TRUE(band.sends(now, Vec3::Zero(), kernels()));
}

// A renderer drops a frame that arrives after a newer one. A frame that was overtaken shows an old surface,
// also if the newer frame was not sent, and if the position of the slave is not known.
TEST(FrameDeadBand, NeverSendsAFrameThatIsOlderOrWasOvertaken) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  const auto sends = [&](double height_m, int number, const std::optional<Vec3>& slave = Vec3::Zero()) {
    return band.sends(frame(plane(height_m), number), slave, kernels());
  };
  EXPECT_TRUE(sends(0, 1));
  EXPECT_TRUE(sends(0.005, 3));
  EXPECT_FALSE(sends(0.002, 2)) << "late";
  for (int newest = 6; newest < 20; newest += 4) {
    EXPECT_FALSE(sends(0.005, newest));
    EXPECT_FALSE(sends(0, newest - 2)) << "late";
    EXPECT_FALSE(sends(0.005, newest - 1, std::nullopt)) << "late";
  }
  EXPECT_EQ(band.sent(), 2);
}

// A region holds the slave's command away from a surface that is farther than near_m.
TEST(FrameDeadBand, LooksBeyondTheRegion) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  const auto lifted = [](double height_m) {
    PointCloud cloud, buffer;
    cloud = plane(height_m)->every_point(kernels(), buffer);
    cloud.fixture_radius_m.assign(cloud.size(), 0.025);
    return make_search(std::move(cloud));
  };
  const Vec3 slave(0, 0.03, 0);
  EXPECT_TRUE(band.sends(frame(lifted(0), 0), slave, kernels()));
  EXPECT_FALSE(band.sends(frame(lifted(0.0005), 1), slave, kernels()));
  EXPECT_TRUE(band.sends(frame(lifted(0.002), 2), slave, kernels()));
}

}  // namespace
}  // namespace remote_touch::dead_band_test
