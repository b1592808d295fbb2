// The oracle against surfaces whose motion is known in closed form.
#include "core/rivals/oracle_proxy_renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/scenes.h"

namespace remote_touch::oracle_proxy_renderer_test {
namespace {

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
}  // namespace remote_touch::oracle_proxy_renderer_test
