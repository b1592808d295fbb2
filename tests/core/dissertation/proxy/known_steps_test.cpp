#include "core/dissertation/proxy/known_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::known_steps_test {
namespace {

KnownStep step_from(const Vec3& proxy_W, double stiffness_N_per_m = 0) {
  return {.proxy_W = proxy_W,
          .normal_W = Vec3::UnitY(),
          .state = ContactState::contact,
          .stiffness_N_per_m = stiffness_N_per_m};
}

TEST(KnownSteps, ReturnsNoStepButThatFromThePosition) {
  const PointCloud places = scenes::random_cloud(3000, 0.01, 5);
  KnownSteps steps;
  std::size_t returned = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    ASSERT_EQ(steps.from(places.point(i)), nullptr);
    steps.remember(step_from(places.point(i), static_cast<double>(i)));
    ASSERT_NE(steps.from(places.point(i)), nullptr);
    for (std::size_t k = i < 100 ? 0 : i - 100; k <= i; ++k)
      if (const KnownStep* const known = steps.from(places.point(k))) {
        ASSERT_EQ(known->stiffness_N_per_m, static_cast<double>(k));
        ++returned;
      }
  }
  EXPECT_GT(returned, 50 * places.size());
}

TEST(KnownSteps, ForgetsWhenTheHipMoves) {
  const Vec3 p(0.1, 0, 0.3), hip_W(0, -0.01, 0);
  KnownSteps steps;
  steps.set_hip(hip_W);
  steps.remember(step_from(p));
  steps.set_hip(hip_W);
  EXPECT_NE(steps.from(p), nullptr);
  EXPECT_EQ(steps.from({0.1, -0.0, 0.3}), nullptr);
  steps.set_hip({-0.0, -0.01, 0});
  EXPECT_EQ(steps.from(p), nullptr);
  steps.remember(step_from(p));
  steps.forget();
  EXPECT_EQ(steps.from(p), nullptr);
}

PointCloud noisy_plane(double sigma_m, unsigned seed, bool with_regions) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sigma_m);
  PointCloud cloud;
  for (int i = -25; i <= 25; ++i)
    for (int k = -25; k <= 25; ++k) {
      cloud.append({0.002 * i + normal(random), normal(random), 0.002 * k + normal(random)});
      if (with_regions) {
        cloud.fixture_radius_m.push_back(0.001 * ((i + k) & 3));
        cloud.stiffness_N_per_m.push_back(300 + i);
      }
    }
  return cloud;
}

// Compares the positions of two proxies after each tick, over frames with new noise. The HIP rests below the
// surface for some ticks at a time. The second proxy makes the 30 steps of a tick in 30 ticks of one step,
// with a change of settings after each, which makes its renderer forget the known steps. So it computes every
// step.
struct Rest {
  int repeated = 0;  // ticks in a cycle of positions
  int different = 0;
};
Rest compare(ProxyParameters p, double sigma_m, bool with_regions) {
  p.velocity_estimate = false, p.max_exit_steps = 0;
  ProxyParameters one = p;
  one.steps_per_tick = 1;
  ProxyRenderer whole = scenes::renderer(p), single = scenes::renderer(one);
  Rest rest;
  for (unsigned frame = 0; frame < 12; ++frame) {
    const PointCloud cloud = noisy_plane(sigma_m, frame, with_regions);
    whole.on_frame(scenes::frame(cloud, static_cast<int>(frame)));
    single.on_frame(scenes::frame(cloud, static_cast<int>(frame)));
    std::vector<Vec3> ends_W;  // positions at the ends of ticks that used all steps
    for (int tick = 0; tick < 30; ++tick) {
      // The HIP comes down in the first frame, and moves in the middle of each later one.
      const Vec3 hip_W(0, frame == 0 && tick < 10 ? 0.02 : -0.01 - 0.001 * (frame + (tick + 15) / 30),
                       0.0003);
      const RenderOutput out = whole.step({hip_W}, 0);
      for (int k = 0; k < 30; ++k) {
        single.step({hip_W}, 0);
        single.parameters_changed();
      }
      rest.different += out.proxy_W == single.proxy_W() ? 0 : 1;
      if (out.steps < 30) continue;
      rest.repeated += std::find(ends_W.begin(), ends_W.end(), out.proxy_W) != ends_W.end() ? 1 : 0;
      ends_W.push_back(out.proxy_W);
    }
  }
  return rest;
}

TEST(KnownSteps, ChangeNoPositionOfTheProxy) {
  for (const double sigma_m : {0.001, 0.004})
    for (const bool with_regions : {false, true})
      for (const auto motion :
           {ContactMotion::tangent_plane, ContactMotion::regions, ContactMotion::creases}) {
        ProxyParameters p;
        p.contact_motion = motion;
        const Rest rest = compare(p, sigma_m, with_regions);
        EXPECT_EQ(rest.different, 0) << sigma_m << " m, regions: " << with_regions;
        if (motion == ContactMotion::tangent_plane) {
          EXPECT_GT(rest.repeated, 5) << sigma_m << " m, regions: " << with_regions;
        }
      }
}

}  // namespace
}  // namespace remote_touch::known_steps_test
