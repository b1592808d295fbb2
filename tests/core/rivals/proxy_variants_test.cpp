#include "core/rivals/proxy_variants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/scenes.h"

namespace remote_touch::proxy_variants_test {
namespace {

// A contact radius that follows the spacing of the points.

// Returns the output after the HIP was pressed 2 cm deep into a grid of this spacing.
RenderOutput press(const DensityProxyParameters& p, double spacing_m) {
  DensityProxyRenderer r(p, 1000, scenes::kernels());
  r.on_frame(scenes::frame(scenes::flat_grid(40, spacing_m)));
  RenderOutput out;
  for (int tick = 0; tick < 600; ++tick)
    out = r.step({Vec3(0, std::max(0.03 - 0.0005 * tick, -0.02), 0)}, 0.001 * tick);
  return out;
}

// A ball of f spacings sinks between four points by f - sqrt(f^2 - 1/2) spacings: 0.063 to 0.095 for f within
// 20 % of 10/3, the range that 24 neighbours on a grid leave open. A ball of one radius falls through points
// that are more than 1.41 r_c apart.
TEST(DensityProxy, DoesNotSinkBetweenSparsePoints) {
  for (const double spacing : {0.0015, 0.003, 0.005}) {
    const RenderOutput out = press({}, spacing);
    EXPECT_NEAR(out.proxy_W.y(), 0.005 - 0.079 * spacing, 0.016 * spacing) << spacing;
    EXPECT_GT(out.force_N.y(), 600 * 0.019) << spacing;
  }
  DensityProxyParameters fixed;
  fixed.min_radius_m = fixed.max_radius_m = 0.005;
  EXPECT_GT(press(fixed, 0.0015).force_N.y(), 600 * 0.019);
  EXPECT_EQ(press(fixed, 0.0075).force_N.y(), 0) << "fallen through";
  EXPECT_GT(press({}, 0.0075).force_N.y(), 600 * 0.018);
}

// r1 and r2 may differ in the last bits.
TEST(DensityProxy, EqualsTheProxyAtTheProxysRadius) {
  DensityProxyParameters fixed;
  fixed.min_radius_m = fixed.max_radius_m = 0.005;
  ProxyRenderer plain({}, 1000, scenes::kernels());
  DensityProxyRenderer adapted(fixed, 1000, scenes::kernels());
  PointCloud cloud = scenes::flat_grid(60);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.y[i] = 0.002 * std::sin(cloud.x[i] / 0.006);
  plain.on_frame(scenes::frame(cloud)), adapted.on_frame(scenes::frame(cloud));
  for (int tick = 0; tick < 200; ++tick) {
    const DeviceState device{Vec3(0.0001 * tick, 0.06 - 0.0004 * tick, 0)};
    const RenderOutput a = plain.step(device, 0.001 * tick), b = adapted.step(device, 0.001 * tick);
    ASSERT_NEAR((a.proxy_W - b.proxy_W).norm(), 0, 1e-6) << tick;
    ASSERT_NEAR((a.force_N - b.force_N).norm(), 0, 1e-3) << tick;
  }
}

TEST(DensityProxy, RefusesLimitsThatAreTheWrongWayRound) {
  DensityProxyParameters p;
  p.max_radius_m = 0.001;
  EXPECT_NE(validate(p).find("max_radius_m"), std::string::npos);
}

// The oracle against surfaces whose motion is known in closed form.

struct Truth final : TrueSurface {
  std::function<double(const Vec3&, double)> distance;
  double signed_distance(const Vec3& p_W, double time_s) const override { return distance(p_W, time_s); }
};

std::shared_ptr<const TrueSurface> truth(std::function<double(const Vec3&, double)> distance) {
  auto surface = std::make_shared<Truth>();
  surface->distance = std::move(distance);
  return surface;
}

TEST(TrueMotion, FollowsATiltedPlaneAndABall) {
  const Vec3 n = Vec3(0.6, 0.8, 0);
  const auto plane = truth([&](const Vec3& p, double t) { return n.dot(p) - 0.2 * t; });
  const SurfaceMotion risen = true_motion(*plane, {0.3, 0.1, 5}, 1, 1.5);
  EXPECT_NEAR((risen.displacement_m - 0.1 * n).norm(), 0, 1e-9);
  EXPECT_NEAR(risen.velocity_m_per_s, 0.2, 1e-12);
  const auto ball = truth([](const Vec3& p, double t) { return (p - Vec3(t, 0, 0)).norm() - 1; });
  const SurfaceMotion moved = true_motion(*ball, {2, 0, 0}, 0, 0.5);
  EXPECT_NEAR((moved.displacement_m - Vec3(0.5, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((moved.normal_W - Vec3::UnitX()).norm(), 0, 1e-9);
}

TEST(TrueMotion, IsNoneWhereItIsNotKnown) {
  const auto unknown = truth([](const Vec3&, double) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_TRUE(true_motion(*unknown, Vec3::Zero(), 0, 1).displacement_m.isZero(0));
  EXPECT_EQ(true_motion(*unknown, Vec3::Zero(), 0, 1).velocity_m_per_s, 0);
}

// Height of the proxy above the plane at the end. The plane jumps at every frame by more than r_c, which no
// estimate follows in time: (4.14).
double end_height(bool has_truth) {
  const auto height = [](double t) { return 3.0 * t * t; };
  OracleProxyRenderer r({}, 1000, scenes::kernels());
  double y = 0, last_s = 0;
  for (int tick = 0; tick < 500; ++tick) {
    if (tick % 33 == 0) {
      last_s = tick / 33 / 30.0;
      Frame frame = scenes::frame(scenes::flat_grid(60, 0.0015, height(last_s)), tick / 33);
      if (has_truth) frame.truth = truth([=](const Vec3& p, double t) { return p.y() - height(t); });
      r.on_frame(frame);
    }
    y = r.step({Vec3(0, tick < 10 ? 0.02 : height(last_s) - 0.02, 0)}, 0.001 * tick).proxy_W.y();
  }
  return y - height(last_s);
}

TEST(OracleProxy, HoldsWithTheTrueMotionAndPopsThroughWithoutIt) {
  EXPECT_NEAR(end_height(true), 0.005, 2e-4);
  EXPECT_NEAR(end_height(false), -0.02, 1e-9);
}

}  // namespace
}  // namespace remote_touch::proxy_variants_test
