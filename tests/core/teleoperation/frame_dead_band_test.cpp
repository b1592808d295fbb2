// The frames that a dead-band sends: closed forms on planes, with noise, and what is seen by one frame only.
#include "core/teleoperation/frame_dead_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/kernels/isa.h"
#include "core/numeric/noise.h"

namespace remote_touch::frame_dead_band_test {
namespace {

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
    EXPECT_NEAR(motion(plane(0), plane(lift)), std::abs(lift), 1e-4 * std::abs(lift) + 1e-15);
    // The distance of planes with a slope is smaller than the lift.
    EXPECT_NEAR(motion(plane(0, 0.5), plane(lift, 0.5)), std::abs(lift) / std::sqrt(1.25),
                0.02 * std::abs(lift) + 1e-15);
  }
}

// Noise is averaged: with 300 points and more, the mean has a tenth of it, and less.
TEST(SurfaceMotion, AveragesNoise) {
  for (std::uint32_t frame = 1; frame < 20; ++frame) {
    EXPECT_LT(motion(plane(0, 0, 0.001, 0), plane(0, 0, 0.001, frame)), 0.0003) << frame;
    EXPECT_NEAR(motion(plane(0, 0, 0.001, 0), plane(0.002, 0, 0.001, frame)), 0.002, 0.0003) << frame;
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
  const Vec3 unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(none.sends(frame(plane(0), i), Vec3::Zero(), kernels()));
    EXPECT_TRUE(wide.sends(frame(plane(0), i), unknown, kernels()));
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
}  // namespace remote_touch::frame_dead_band_test
