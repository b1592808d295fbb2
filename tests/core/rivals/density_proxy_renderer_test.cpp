// A contact radius that follows the spacing of the points.
#include "core/rivals/density_proxy_renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace remote_touch::density_proxy_renderer_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::density_proxy_renderer_test
