// The frames that a dead-band sends: closed forms on planes, with noise, and what is seen by one frame only.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/points/noise.h"
#include "core/teleoperation/channel.h"
#include "tests/support/scenes.h"

namespace remote_touch::frame_dead_band_test {
namespace {

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
}  // namespace remote_touch::frame_dead_band_test
