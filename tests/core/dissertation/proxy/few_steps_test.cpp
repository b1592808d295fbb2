// The setting with few steps that the description of steps_per_tick recommends: where it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/scenes.h"

namespace remote_touch::few_steps_test {
namespace {

ProxyParameters stepping(double gamma, int steps_per_tick) {
  ProxyParameters p;
  p.gamma = gamma, p.steps_per_tick = steps_per_tick;
  return p;
}

// Points 2 mm apart, with normally distributed heights.
PointCloud noisy_plane(double sigma_m) {
  std::mt19937 random(1);
  std::normal_distribution<double> height(0, 1);
  PointCloud cloud;
  for (int i = -50; i <= 50; ++i)
    for (int k = -20; k <= 20; ++k) cloud.append({0.002 * i, sigma_m * height(random), 0.002 * k});
  return cloud;
}

// Returns where the proxy rests after the HIP has come down and slid 5 mm below the plane to x.
Vec3 rest_of(const PointCloud& cloud, const ProxyParameters& parameters, double x) {
  constexpr int kTicks = 100;
  ProxyRenderer renderer = scenes::renderer(parameters);
  renderer.on_frame(scenes::frame(cloud));
  renderer.step({Vec3(x - 0.01, 0.02, 0.0003)}, 0);
  RenderOutput out;
  for (int tick = 0; tick < kTicks + 40; ++tick)
    out = renderer.step({Vec3(x - 0.01 * std::max(0, kTicks - tick) / kTicks, -0.005, 0.0003)}, 0);
  return out.proxy_W;
}

// The rest depends on the way to it by as much as the contact region is thick, 20 um.
TEST(FewSteps, EndWhereAThousandStepsEnd) {
  for (const double sigma_m : {0.0, 0.001}) {
    const PointCloud cloud = noisy_plane(sigma_m);
    for (int i = 0; i < 25; ++i) {
      const double x = -0.05 + 0.0041 * i;
      const Vec3 limit_W = rest_of(cloud, stepping(0.3, 1000), x);
      EXPECT_LT((rest_of(cloud, stepping(0.5, 8), x) - limit_W).norm(), 20e-6) << sigma_m << " m, x = " << x;
      EXPECT_LT((rest_of(cloud, stepping(0.3, 10), x) - limit_W).norm(), 20e-6) << sigma_m << " m, x = " << x;
    }
  }
}

TEST(FewSteps, AreTooFewWhereTheyDoNotArrive) {
  const PointCloud cloud = noisy_plane(0);
  EXPECT_GT((rest_of(cloud, stepping(0.01, 8), 0) - rest_of(cloud, stepping(0.3, 1000), 0)).norm(), 20e-6);
}

}  // namespace
}  // namespace remote_touch::few_steps_test
