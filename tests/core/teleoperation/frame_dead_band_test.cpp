// The frames that a dead-band sends: closed forms on planes, with noise, and what is seen by one frame only.
#include "core/teleoperation/frame_dead_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "core/kernels/isa.h"

namespace remote_touch::frame_dead_band_test {
namespace {

using Points = std::shared_ptr<const NeighbourSearch>;

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
    if (band.sends(plane(0.0003 * i), slave, kernels())) sent.push_back(i);
  EXPECT_EQ(sent, (std::vector<int>{0, 4, 8, 12, 16, 20, 24, 28}));
  EXPECT_EQ(band.sent(), 8);
  EXPECT_TRUE(band.sends(nothing(), slave, kernels()));
}

TEST(FrameDeadBand, SendsAllWithoutABandAndBeforeTheSlaveStarts) {
  FrameDeadBand none({});
  FrameDeadBand wide({.least_motion_m = 1});
  const Vec3 unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(none.sends(plane(0), Vec3::Zero(), kernels()));
    EXPECT_TRUE(wide.sends(plane(0), unknown, kernels()));
  }
  EXPECT_FALSE(wide.sends(plane(0.01), Vec3::Zero(), kernels()));
  EXPECT_EQ(none.sent(), 3);
  EXPECT_EQ(wide.sent(), 3);
}

}  // namespace
}  // namespace remote_touch::frame_dead_band_test
