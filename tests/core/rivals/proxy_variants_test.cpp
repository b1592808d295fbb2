// Variants of the proxy, and direct rendering: averages of frames, radii, true motion, and the settings of
// all rivals.
#include "core/rivals/proxy_variants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/mls_surface_renderer.h"
#include "core/rivals/rival_renderer.h"
#include "tests/core/rivals/moved_hip.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::proxy_variants_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Returns the heights at which one point of a grid is shown if it is measured at these heights. NaN: missing.
std::vector<double> shown(const FrameAverageSettings& s, const std::vector<double>& measured) {
  FrameAverage average(s, scenes::kernels());
  std::vector<double> heights;
  for (const double y : measured) {
    PointCloud cloud = scenes::flat_grid(20);
    cloud.y[57] = y;
    if (std::isnan(y)) cloud.x[57] = cloud.z[57] = kNaN;
    const auto points = average.next(*make_search(cloud));
    EXPECT_EQ(points->size(), cloud.size());
    EXPECT_EQ(points->organised_columns(), 20);
    const GatheredPoints all = scenes::gathered(*points);
    double height = kNaN;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all.index()[i] == 57) height = all.view().y[i];
    heights.push_back(height);
  }
  return heights;
}

void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(b[i]))
      EXPECT_TRUE(std::isnan(a[i])) << i;
    else
      EXPECT_NEAR(a[i], b[i], 1e-15) << i;
  }
}

// The default rule is the recursion below the threshold, and the new depth above it. A missing point is kept
// if it was measured twice in the last four frames.
TEST(FrameAverage, FollowsItsRule) {
  FrameAverageSettings never, mean;
  never.persistence_frames = 0;
  mean.rule = AverageRule::mean, mean.mean_frames = 3;
  expect_same(shown({}, {0, 0.01, 0.01, 0.05, 0.04}), {0, 0.004, 0.0064, 0.05, 0.046});
  expect_same(shown({}, {0.001, kNaN, 0.001, kNaN, kNaN, kNaN, 0.001}),
              {0.001, kNaN, 0.001, 0.001, kNaN, kNaN, 0.001});
  expect_same(shown(never, {0.001, 0.001, kNaN, 0.001}), {0.001, 0.001, kNaN, 0.001});
  expect_same(shown(mean, {0, 0.003, 0.006, 0.009, kNaN, 0.012}), {0, 0.0015, 0.003, 0.006, kNaN, 0.0105});
}

// The point moves along its ray, so it stays in its pixel.
TEST(FrameAverage, APointOfAnImageMovesAlongItsRay) {
  const CameraIntrinsics camera{32, 32, 100, 100, 15.5, 15.5};
  FrameAverage average({}, scenes::kernels());
  std::shared_ptr<const NeighbourSearch> points;
  for (const double depth : {0.50, 0.51}) {
    const DepthImage image{32, 32, std::vector<double>(32 * 32, depth)};
    points = average.next(*make_search(cloud_from_depth(image, camera, RigidTransform::Identity())));
  }
  const GatheredPoints all = scenes::gathered(*points);
  ASSERT_EQ(all.size(), 1024u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double u = all.index()[i] % 32, v = all.index()[i] / 32;
    const Vec3 expected = unproject(camera, u, v, 0.504);
    EXPECT_NEAR((Vec3(all.view().x[i], all.view().y[i], all.view().z[i]) - expected).norm(), 0, 1e-12);
  }
}

TEST(FrameAverage, AnEmptyFrameIsOneInWhichAllAreMissing) {
  FrameAverage average({}, scenes::kernels());
  const auto count = [](const NeighbourSearch& points) { return scenes::gathered(points).size(); };
  average.next(*make_search(scenes::flat_grid(20)));
  average.next(*make_search(scenes::flat_grid(20)));
  EXPECT_EQ(count(*average.next(*make_search({}))), 400u);
  EXPECT_EQ(count(*average.next(*make_search({}))), 400u);
  EXPECT_EQ(count(*average.next(*make_search({}))), 0u) << "measured once in four frames";
  EXPECT_EQ(count(*average.next(*make_search(scenes::flat_grid(10)))), 100u);
}

TEST(FrameAverage, RegionsAndStiffnessAreThoseOfTheNewestFrame) {
  FrameAverage average({}, scenes::kernels());
  PointCloud cloud = scenes::flat_grid(20);
  cloud.fixture_radius_m.assign(cloud.size(), 0.003);
  cloud.stiffness_N_per_m.assign(cloud.size(), 50);
  cloud.fixture_radius_m[7] = 0.01;
  const auto points = average.next(*make_search(cloud));
  EXPECT_TRUE(points->has_regions());
  EXPECT_EQ(points->max_fixture_radius_m(), 0.01);
  const GatheredPoints all = scenes::gathered(*points);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all.view().radius[i], all.index()[i] == 7 ? 0.01 : 0.003);
    EXPECT_EQ(all.view().stiffness[i], 50);
  }
}

TEST(BlockSearch, FindsWhatBruteForceFinds) {
  PointCloud cloud = scenes::random_cloud(1000, 0.05, 4);
  for (int i = 0; i < 1000; ++i) cloud.fixture_radius_m.push_back(i % 50 == 0 ? 0.02 : 0);
  const BruteForceSearch oracle(cloud);
  BlockSearch search;
  search.clear(1003, 0, true, false);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    search.set(i, cloud.point(i));
    search.set_fixture_radius(i, cloud.fixture_radius_m[i]);
  }
  search.finish();
  for (const double radius : {0.0, 0.004, 0.03, 0.2}) {
    const Ball ball{Vec3(0.01, -0.02, 0.005), radius};
    const GatheredPoints a = scenes::gathered(oracle, ball), b = scenes::gathered(search, ball);
    ASSERT_EQ(a.size(), b.size()) << radius;
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a.index()[i], b.index()[i]);
  }
}

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

TEST(TrueMotion, FollowsATiltedPlaneAndABallAndIsNoneWhereItIsNotKnown) {
  const Vec3 n = Vec3(0.6, 0.8, 0);
  const auto plane = truth([&](const Vec3& p, double t) { return n.dot(p) - 0.2 * t; });
  const SurfaceMotion risen = true_motion(*plane, {0.3, 0.1, 5}, 1, 1.5);
  EXPECT_NEAR((risen.displacement_m - 0.1 * n).norm(), 0, 1e-9);
  EXPECT_NEAR(risen.velocity_m_per_s, 0.2, 1e-12);
  const auto ball = truth([](const Vec3& p, double t) { return (p - Vec3(t, 0, 0)).norm() - 1; });
  const SurfaceMotion moved = true_motion(*ball, {2, 0, 0}, 0, 0.5);
  EXPECT_NEAR((moved.displacement_m - Vec3(0.5, 0, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR((moved.normal_W - Vec3::UnitX()).norm(), 0, 1e-9);
  const auto unknown = truth([](const Vec3&, double) { return kNaN; });
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

// --- direct rendering ---

constexpr double kRadius_m = 0.005, kStiffness_N_per_m = 600;

PenaltyRenderer over(const PointCloud& cloud, const PenaltyParameters& p = {}) {
  return moved_hip::over<PenaltyRenderer>(cloud, p);
}

Vec3 force(PenaltyRenderer& r, const Vec3& hip, double time_s = 0) {
  return r.step({hip}, time_s).force_N;
}

// The nearest distance over a point of a dense plane is the height, and the normal points away from the
// plane: behind it, the force points away from its front, which is the known weakness of direct rendering.
TEST(PenaltyRenderer, PushesByHowFarTheNearestPointIsInTheBall) {
  PenaltyRenderer r = over(scenes::flat_grid(61, 0.0005));
  for (const double height : {0.0045, 0.002, 0.0005, -0.0005, -0.002, -0.0045}) {
    const RenderOutput out = r.step({Vec3(0, height, 0)}, 0);
    const double expected_N = std::copysign(kStiffness_N_per_m * (kRadius_m - std::abs(height)), height);
    EXPECT_NEAR(out.force_N.y(), expected_N, 1e-9);
    EXPECT_NEAR(std::hypot(out.force_N.x(), out.force_N.z()), 0, 1e-9);
    EXPECT_NEAR(out.nearest_distance_m, std::abs(height), 1e-12);
    EXPECT_EQ(out.state, ContactState::contact);
    EXPECT_EQ(out.proxy_W, Vec3(0, height, 0));
  }
}

TEST(PenaltyRenderer, IsZeroInFreeSpaceAndRisesFromZeroAtTheRim) {
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()})), empty = over({});
  EXPECT_EQ(force(r, {0, kRadius_m, 0}), Vec3::Zero());
  EXPECT_EQ(force(r, {0.02, 0, 0}), Vec3::Zero());
  EXPECT_NEAR(force(r, {0, kRadius_m - 1e-6, 0}).y(), kStiffness_N_per_m * 1e-6, 1e-12);
  const RenderOutput nothing = empty.step({Vec3(0, 0.001, 0)}, 0.04);
  EXPECT_TRUE(nothing.force_N.isZero(0));
  EXPECT_TRUE(std::isinf(nothing.nearest_distance_m));
}

// A difference is spread over missed ticks.
TEST(PenaltyRenderer, TheDamperSlowsAlongTheNormalAndNeverPulls) {
  PenaltyParameters p;
  p.damping_Ns_per_m = 2;
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}), p),
                  missed = over(scenes::cloud_of({Vec3::Zero()}), p);
  force(r, {0, 0.004, 0}, 0), force(missed, {0, 0.004, 0}, 0);
  EXPECT_NEAR(force(r, {0, 0.0035, 0}, 0.001).y(), kStiffness_N_per_m * 0.0015 + 2 * 0.5, 1e-9);
  EXPECT_TRUE(force(r, {0, 0.0049, 0}, 0.002).isZero(0)) << "out at 1.4 m/s: the damper would pull";
  EXPECT_NEAR(force(missed, {0, 0.003, 0}, 0.004).y(), kStiffness_N_per_m * 0.002 + 2 * 0.25, 1e-9);
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

// The base of all rivals; see RenderOutput::slave_W.
TEST(PenaltyRenderer, SlaveIsNotSentAnywhereBeforeTheHipIsKnown) {
  PenaltyRenderer r = over(scenes::cloud_of({Vec3::Zero()}));
  const Vec3 lost = Vec3::Constant(std::nan("")), hip(0, 0.02, 0);
  EXPECT_TRUE(r.step({lost}, 0).slave_W.array().isNaN().all());
  EXPECT_EQ(r.step({hip}, 0.001).slave_W, hip);
  EXPECT_EQ(r.step({lost}, 0.002).slave_W, hip) << "the last command is repeated";
}

// --- settings of all rivals that do not fit together ---

TEST(RivalSettings, RefuseWhatDoesNotFitTogether) {
  PenaltyParameters penalty;
  DensityProxyParameters density;
  GodObjectParameters god_object;
  MlsSurfaceParameters zero_width, small_width, no_view;
  zero_width.weight_width_m = 0;
  for (const std::string& valid : {validate(penalty), validate(density), validate(god_object),
                                   validate(small_width), validate(zero_width)})
    EXPECT_EQ(valid, "");
  penalty.contact_radius_m = penalty.r3_m;
  density.max_radius_m = 0.001;
  god_object.max_edge_length_m = 0.00005;
  small_width.weight_width_m = 1e-9;
  no_view.view_direction = Vec3::Zero();
  const std::pair<std::string, const char*> rows[] = {
      {validate(penalty), "contact_radius_m = 0.01: expected below r3_m = 0.01"},
      {validate(density), "max_radius_m"},
      {validate(god_object),
       "surface_offset_m = 1e-05: expected at most a tenth of max_edge_length_m = 5e-05"},
      {validate(small_width), "weight_width_m: expected 0, or 0.000001 or more"},
      {validate(no_view), "view_direction: expected a vector of length 0.001 or more"}};
  for (const auto& [problem, expected] : rows) EXPECT_HAS(problem, expected);
}

}  // namespace
}  // namespace remote_touch::proxy_variants_test
