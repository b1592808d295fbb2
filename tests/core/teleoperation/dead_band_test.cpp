#include "core/teleoperation/channel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/points/noise.h"
#include "core/points/vector.h"

namespace remote_touch::dead_band_test {
namespace {

// The perceptual dead-band: closed forms of the packets that are sent.

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

// --- settings ---

TEST(DeadBandSettings, RefusesAFractionThatHidesTheEndOfAForce) {
  EXPECT_EQ(validate(DeadBandSettings{}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 0.999}), "");
  EXPECT_EQ(validate(DeadBandSettings{.weber_fraction = 1}),
            "weber_fraction = 1.000000: expected less than 1");
  const Signal off = [](int k) { return Vec3(k == 0 ? 2 : 0, 0, 0); };
  EXPECT_EQ(sent_ticks({.weber_fraction = 0.999}, 5, off), (std::vector<int>{0, 1}));
}

TEST(DeadBandSettings, HasARangeForEveryNumber) {
  DeadBandSettings s;
  std::vector<std::string> names;
  for (const Parameter& p : parameters(s)) {
    names.push_back(p.name);
    if (const auto* const* number = std::get_if<double*>(&p.value)) {
      EXPECT_EQ(p.low, **number) << p.name;
      EXPECT_LT(p.low, p.high) << p.name;
    }
  }
  EXPECT_EQ(names, (std::vector<std::string>{"weber_fraction", "least", "predicts", "longest_silence_s"}));
}

// --- hold ---

TEST(DeadBand, SendsEverySampleByDefault) {
  EXPECT_EQ(sent_ticks({}, 100, [](int) { return Vec3(1, 2, 3); }), multiples(1, 100));
  EXPECT_EQ(sent_ticks({.predicts = true}, 100, [](int) { return Vec3(1, 2, 3); }), multiples(1, 100));
}

TEST(DeadBand, SendsNothingAfterTheFirstSampleOfAConstant) {
  for (const Vec3& value : {Vec3(0, 0, 0), Vec3(1, 2, 3)})
    for (const bool predicts : {false, true}) {
      EXPECT_EQ(sent_ticks({.weber_fraction = 0.1, .predicts = predicts}, 100, [&](int) { return value; }),
                (std::vector<int>{0}));
      EXPECT_EQ(sent_ticks({.least = 0.1, .predicts = predicts}, 100, [&](int) { return value; }),
                (std::vector<int>{0}));
    }
}

// The difference must exceed the threshold: a ramp of one quantum per tick and a threshold of five, all exact
// in binary.
TEST(DeadBand, SendsARampAtEqualSteps) {
  const Signal ramp = [](int k) { return Vec3(0, k * 0x1p-10, 0); };
  EXPECT_EQ(sent_ticks({.least = 5 * 0x1p-10}, 100, ramp), multiples(6, 100));
}

// A Weber fraction gives equal ratios: 1.01^9 < 1.1 < 1.01^10.
TEST(DeadBand, SendsGrowthAtEqualRatios) {
  const Signal growth = [](int k) { return Vec3(0, 0, std::pow(1.01, k)); };
  EXPECT_EQ(sent_ticks({.weber_fraction = 0.1}, 200, growth), multiples(10, 200));
  // Below 3 the least difference of 0.3 decides, above it the fraction.
  int sent = 0;
  for (const int k : sent_ticks({.weber_fraction = 0.1, .least = 0.3}, 200, growth)) {
    if (k > 0) {
      const double from = std::pow(1.01, sent), to = std::pow(1.01, k), before = std::pow(1.01, k - 1);
      EXPECT_GT(to - from, std::max(0.3, 0.1 * from));
      EXPECT_LE(before - from, std::max(0.3, 0.1 * from));
    }
    sent = k;
  }
}

// A vector that turns by 1 degree per tick leaves the ball when its chord 2 sin(a / 2) exceeds the fraction.
TEST(DeadBand, SendsATurningVectorByItsChord) {
  const Signal turning = [](int k) {
    const double angle = k * std::numbers::pi / 180;
    return Vec3(7 * std::cos(angle), 0, 7 * std::sin(angle));
  };
  for (const double fraction : {0.05, 0.1, 0.2}) {
    const double degrees = 2 * std::asin(fraction / 2) * 180 / std::numbers::pi;
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction}, 360, turning),
              multiples(static_cast<int>(std::floor(degrees)) + 1, 360));
  }
}

// --- prediction ---

TEST(DeadBand, SendsARampByTwoPacketsIfItPredicts) {
  const Signal ramp = [](int k) { return Vec3(1 + 0.002 * k, -0.001 * k, 3); };
  const DeadBandSettings holds{.weber_fraction = 0.05}, predicts{.weber_fraction = 0.05, .predicts = true};
  EXPECT_EQ(sent_ticks(predicts, 5000, ramp).size(), 2u);
  EXPECT_GT(sent_ticks(holds, 5000, ramp).size(), 20u);
}

TEST(DeadBand, PredictsThroughTheLastTwoPackets) {
  DeadBandSender sender({.least = 0.5, .predicts = true});
  const auto first = sender.send({1, 1, 1}, 2.0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->slope_per_s, Vec3::Zero());
  EXPECT_FALSE(sender.send({1, 1.4, 1}, 2.1));
  const auto second = sender.send({1, 2, 1}, 2.25);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->slope_per_s, Vec3(0, 4, 0));
  EXPECT_EQ(second->sent_s, 2.25);
  EXPECT_EQ(sender.shown(2.5), Vec3(1, 3, 1));
  EXPECT_FALSE(sender.send({1, 3.4, 1}, 2.5));
  EXPECT_TRUE(sender.send({1, 3.6, 1}, 2.5));
  EXPECT_EQ(sender.shown(2.5), Vec3(1, 3.6, 1));
}

TEST(DeadBand, PredictsNothingFromTwoPacketsAtTheSameTime) {
  DeadBandSender sender({.predicts = true});
  sender.send({1, 0, 0}, 1);
  const auto sample = sender.send({2, 0, 0}, 1);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->slope_per_s, Vec3::Zero());
}

// --- a sine against plain loops ---

struct Wave {
  double bias, amplitude, rate_hz;
  double at(int k) const { return bias + amplitude * std::sin(2 * std::numbers::pi * rate_hz * k * kTick_s); }
};

// Counts in one dimension from the list of all values: for each packet it searches the next one.
int searched_packets(const Wave& wave, double fraction, bool predicts, int ticks) {
  std::vector<int> sent{0};
  for (;;) {
    const int last = sent.back();
    double slope_per_tick = 0;
    if (predicts && sent.size() > 1) {
      const int before = sent[sent.size() - 2];
      slope_per_tick = (wave.at(last) - wave.at(before)) / (last - before);
    }
    int next = last + 1;
    for (; next < ticks; ++next) {
      const double shown = wave.at(last) + slope_per_tick * (next - last);
      if (std::fabs(wave.at(next) - shown) > fraction * std::fabs(shown)) break;
    }
    if (next >= ticks) return static_cast<int>(sent.size());
    sent.push_back(next);
  }
}

TEST(DeadBand, SendsASineAsOftenAsASearchFinds) {
  constexpr int kTicks = 10000;
  for (const Wave& wave : {Wave{0, 1, 1}, Wave{3, 1, 2}, Wave{1.5, 1, 0.7}})
    for (const double fraction : {0.05, 0.1, 0.2})
      for (const bool predicts : {false, true}) {
        const DeadBandSettings s{.weber_fraction = fraction, .predicts = predicts};
        const auto sent = sent_ticks(s, kTicks, [&](int k) { return Vec3(0, wave.at(k), 0); });
        const int want = searched_packets(wave, fraction, predicts, kTicks);
        EXPECT_EQ(static_cast<int>(sent.size()), want) << wave.bias << " " << fraction << " " << predicts;
        EXPECT_LT(want, kTicks / 4);
      }
}

// Holding a positive sine needs a packet for each change of the logarithm by ln(1 + k) or
// ln(1 / (1 - k)); both ends of a half wave and the sampling may cost one packet each.
TEST(DeadBand, HoldsAPositiveSineByTheLogarithm) {
  const Wave wave{3, 1, 0.1};
  constexpr int kTicks = 10001;  // one period: from 3 up to 4, down to 2 and up to 3
  const auto sent =
      sent_ticks({.weber_fraction = 0.01}, kTicks, [&](int k) { return Vec3(wave.at(k), 0, 0); });
  const double up = std::log(4.0 / 3) + std::log(3.0 / 2), down = std::log(4.0 / 2);
  const double want = up / std::log(1.01) + down / -std::log(0.99);
  EXPECT_NEAR(static_cast<double>(sent.size()), want, 5);
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

// --- silence ---

TEST(DeadBand, BreaksItsSilence) {
  for (const double fraction : {0.05, 0.2})
    EXPECT_EQ(sent_ticks({.weber_fraction = fraction, .longest_silence_s = 0.05}, 1000,
                         [](int) { return Vec3(1, 2, 3); }),
              multiples(50, 1000));
}

// The frames that a dead-band sends: closed forms on planes, with noise, and what is seen by one frame only.

using Points = std::shared_ptr<const NeighbourSearch>;

// A frame that was captured at 1 s times its number.
Frame frame(Points points, int number) {
  Frame made;
  made.index = number, made.captured_s = number, made.points = std::move(points);
  return made;
}

const Kernels& kernels() {
  static const Kernels& k = kernels_for(best_isa());
  return k;
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

TEST(SurfaceMotion, IsTheDistanceOfParallelPlanes) {
  for (const double lift : {0.0, 0.0005, -0.003}) {
    EXPECT_NEAR(motion(plane(0), plane(lift)), std::abs(lift), 1e-13);
    // The distance of planes with a slope is smaller than the lift.
    EXPECT_NEAR(motion(plane(0, 0.5), plane(lift, 0.5)), std::abs(lift) / std::sqrt(1.25), 1e-13);
  }
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

// The renderer never has a plane that is farther from the surface than the band, anywhere on the disc, while
// the surface rocks by 20 degrees and rises and sinks.
TEST(FrameDeadBand, BoundsTheErrorOfASurfaceThatRocks) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  double shown_lift = 0, shown_slope = 0;
  int sent = 0;
  for (int i = 0; i < 90; ++i) {
    const double lift = 0.004 * std::sin(0.05 * i), slope = std::tan(0.35 * std::sin(0.1 * i));
    const bool sends = band.sends(frame(plane(lift, slope), i), Vec3(0, 0.001, 0), kernels());
    if (sends) shown_lift = lift, shown_slope = slope, ++sent;
    const double turn = std::abs(std::atan(slope) - std::atan(shown_slope));
    EXPECT_LE(turn, std::atan(0.001 / 0.02)) << i;
    EXPECT_LE(std::abs(lift - shown_lift) * std::cos(std::atan(shown_slope)), 0.0011) << i;
  }
  EXPECT_GT(sent, 20);
  EXPECT_LT(sent, 60);
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

// A renderer drops a frame that arrives after a newer one, so it must not become the reference.
TEST(FrameDeadBand, NeverSendsAFrameThatIsOlderThanTheLastThatWasSent) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  EXPECT_TRUE(band.sends(frame(plane(0), 1), Vec3::Zero(), kernels()));
  EXPECT_TRUE(band.sends(frame(plane(0.005), 3), Vec3::Zero(), kernels()));
  EXPECT_FALSE(band.sends(frame(plane(0.002), 2), Vec3::Zero(), kernels())) << "late";
  EXPECT_FALSE(band.sends(frame(plane(0.005), 4), Vec3::Zero(), kernels()));
  EXPECT_EQ(band.sent(), 2);
}

// A frame that was overtaken shows an old surface, also if the newer frame was not sent, and if the position
// of the slave is not known.
TEST(FrameDeadBand, NeverSendsAFrameThatWasOvertaken) {
  FrameDeadBand band({.least_motion_m = 0.001, .near_m = 0.02});
  EXPECT_TRUE(band.sends(frame(plane(0), 1), Vec3::Zero(), kernels()));
  for (int newest = 4; newest < 20; newest += 4) {
    EXPECT_FALSE(band.sends(frame(plane(0), newest), Vec3::Zero(), kernels()));
    EXPECT_FALSE(band.sends(frame(plane(0.005), newest - 2), Vec3::Zero(), kernels())) << "late";
    EXPECT_FALSE(band.sends(frame(plane(0), newest - 1), std::nullopt, kernels())) << "late";
  }
  EXPECT_EQ(band.sent(), 1);
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
