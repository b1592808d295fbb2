#include "core/rivals/rival_renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

namespace remote_touch::penalty_renderer_test {
namespace {

constexpr double kRadius_m = 0.005, kStiffness_N_per_m = 600;

PenaltyRenderer over(const PointCloud& cloud, const PenaltyParameters& p = {}) {
  PenaltyRenderer renderer(p, 1000, scenes::kernels());
  renderer.on_frame(scenes::frame(cloud));
  return renderer;
}

Vec3 force(PenaltyRenderer& r, const Vec3& hip, double time_s = 0) {
  return r.step({hip}, time_s).force_N;
}

// The nearest distance over a point of a dense plane is the height, and the normal points up.
TEST(PenaltyRenderer, PushesByHowFarTheNearestPointIsInTheBall) {
  PenaltyRenderer r = over(scenes::flat_grid(61, 0.0005));
  for (const double height : {0.0005, 0.002, 0.0045}) {
    const RenderOutput out = r.step({Vec3(0, height, 0)}, 0);
    EXPECT_NEAR(out.force_N.y(), kStiffness_N_per_m * (kRadius_m - height), 1e-9);
    EXPECT_NEAR(std::hypot(out.force_N.x(), out.force_N.z()), 0, 1e-9);
    EXPECT_NEAR(out.nearest_distance_m, height, 1e-12);
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_EQ(out.proxy_W, Vec3(0, height, 0));
  }
}

TEST(PenaltyRenderer, IsZeroInFreeSpaceAndRisesFromZeroAtTheRim) {
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}));
  EXPECT_EQ(force(r, {0, kRadius_m, 0}), Vec3::Zero());
  EXPECT_EQ(force(r, {0.02, 0, 0}), Vec3::Zero());
  EXPECT_NEAR(force(r, {0, kRadius_m - 1e-6, 0}).y(), kStiffness_N_per_m * 1e-6, 1e-12);
}

// The known weakness of direct rendering: behind the surface, the force points away from its front.
TEST(PenaltyRenderer, PopsThrough) {
  PenaltyRenderer r = over(scenes::flat_grid(61, 0.0005));
  double highest = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const double height = 0.01 - 0.0001 * (tick + 0.5);
    const Vec3 f = force(r, {0, height, 0}, 0.001 * tick);
    highest = std::max(highest, f.y());
    const bool in_reach = std::abs(height) < kRadius_m;
    EXPECT_EQ(f.y() > 0, in_reach && height > 0) << height;
    EXPECT_EQ(f.y() < 0, in_reach && height < 0) << height;
  }
  EXPECT_GT(highest, 0.98 * kStiffness_N_per_m * kRadius_m);
  EXPECT_LE(highest, kStiffness_N_per_m * kRadius_m);
}

TEST(PenaltyRenderer, TheDamperSlowsAlongTheNormalAndNeverPulls) {
  PenaltyParameters p;
  p.damping_Ns_per_m = 2;
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}), p);
  force(r, {0, 0.004, 0}, 0);
  const double spring = kStiffness_N_per_m * 0.0015;
  EXPECT_NEAR(force(r, {0, 0.0035, 0}, 0.001).y(), spring + 2 * 0.5, 1e-9);
  EXPECT_TRUE(force(r, {0, 0.0049, 0}, 0.002).isZero(0)) << "out at 1.4 m/s: the damper would pull";
}

TEST(PenaltyRenderer, TheDamperSpreadsADifferenceOverMissedTicks) {
  PenaltyParameters p;
  p.damping_Ns_per_m = 2;
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}), p);
  force(r, {0, 0.004, 0}, 0);
  EXPECT_NEAR(force(r, {0, 0.003, 0}, 0.004).y(), kStiffness_N_per_m * 0.002 + 2 * 0.25, 1e-9);
}

// (5.5), (5.8): a point with a region and a stiffness of its own.
TEST(PenaltyRenderer, TakesRegionsAndStiffnessOfThePoints) {
  PointCloud cloud = scenes::cloud_of({Vec3::Zero()});
  cloud.fixture_radius_m = {0.01}, cloud.stiffness_N_per_m = {250};
  PenaltyRenderer r = over(cloud);
  EXPECT_NEAR(force(r, {0, 0.012, 0}).y(), 250 * 0.003, 1e-6);
}

TEST(PenaltyRenderer, HasNoDirectionAtAPointUntilItHadOne) {
  PenaltyRenderer fresh = over(scenes::cloud_of({Vec3::Zero()}));
  const RenderOutput out = fresh.step({Vec3::Zero()}, 0);
  EXPECT_EQ(out.status, RenderStatus::degenerate_normal);
  EXPECT_TRUE(out.force_N.isZero(0));
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}));
  force(r, {0, 0.001, 0});
  EXPECT_NEAR(force(r, Vec3::Zero()).y(), kStiffness_N_per_m * kRadius_m, 1e-12);
}

TEST(PenaltyRenderer, AnEmptyFrameHasNoForceAndAStaleOneIsReported) {
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}));
  r.on_frame(scenes::frame({}, 1));
  const RenderOutput empty = r.step({Vec3(0, 0.001, 0)}, 0.04);
  EXPECT_TRUE(empty.force_N.isZero(0));
  EXPECT_TRUE(std::isinf(empty.nearest_distance_m));
  r.on_frame(scenes::frame(scenes::cloud_of({Vec3::Zero()}), 0));
  const RenderOutput stale = r.step({Vec3(0, 0.001, 0)}, 0.041);
  EXPECT_EQ(stale.status, RenderStatus::stale_frame_dropped);
  EXPECT_EQ(stale.frame_index, 1);
  EXPECT_TRUE(stale.force_N.isZero(0));
}

// The base of all rivals; see RenderOutput::slave_W.
TEST(PenaltyRenderer, SlaveIsNotSentAnywhereBeforeTheHipIsKnown) {
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}));
  const Vec3 lost = Vec3::Constant(std::nan("")), hip(0, 0.02, 0);
  EXPECT_TRUE(r.step({lost}, 0).slave_W.array().isNaN().all());
  EXPECT_EQ(r.step({hip}, 0.001).slave_W, hip);
  EXPECT_EQ(r.step({lost}, 0.002).slave_W, hip) << "the last command is repeated";
}

TEST(PenaltyRenderer, RefusesABallLargerThanTheNeighbourhoodOfNormals) {
  PenaltyParameters p;
  EXPECT_EQ(validate(p), "");
  p.contact_radius_m = p.r3_m;
  EXPECT_EQ(validate(p), "contact_radius_m = 0.01: expected below r3_m = 0.01");
}

}  // namespace
}  // namespace remote_touch::penalty_renderer_test
