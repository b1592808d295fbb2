// Averages over frames compared with their recursions, and their treatment of a missing point.
#include "core/rivals/frame_average.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/camera.h"
#include "core/rivals/proxy_variants.h"
#include "tests/support/scenes.h"

namespace remote_touch::frame_average_test {
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

TEST(FrameAverage, ExponentialFollowsTheRecursionBelowTheThresholdAndTheNewDepthAboveIt) {
  expect_same(shown({}, {0, 0.01, 0.01, 0.05, 0.04}), {0, 0.004, 0.0064, 0.05, 0.046});
}

TEST(FrameAverage, AMissingPointIsKeptIfMeasuredTwiceInTheLastFourFrames) {
  expect_same(shown({}, {0.001, kNaN, 0.001, kNaN, kNaN, kNaN, 0.001}),
              {0.001, kNaN, 0.001, 0.001, kNaN, kNaN, 0.001});
  FrameAverageSettings never;
  never.persistence_frames = 0;
  expect_same(shown(never, {0.001, 0.001, kNaN, 0.001}), {0.001, 0.001, kNaN, 0.001});
}

TEST(FrameAverage, MeanIsThatOfTheLastFramesInWhichThePointWasMeasured) {
  FrameAverageSettings s;
  s.rule = AverageRule::mean, s.mean_frames = 3;
  expect_same(shown(s, {0, 0.003, 0.006, 0.009, kNaN, 0.012}), {0, 0.0015, 0.003, 0.006, kNaN, 0.0105});
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

// A surface at rest without noise has nothing to average.
TEST(AveragedProxy, IsTheProxyOnASurfaceAtRestAndLagsBehindOneThatMoves) {
  for (const double speed : {0.0, 0.06}) {
    ProxyRenderer plain({}, 1000, scenes::kernels());
    AveragedProxyRenderer averaged({}, 1000, scenes::kernels());
    RenderOutput a, b;
    for (int tick = 0; tick < 600; ++tick) {
      if (tick % 33 == 0) {
        const Frame frame = scenes::frame(scenes::flat_grid(60, 0.0015, speed * (tick / 33) / 30), tick / 33);
        plain.on_frame(frame), averaged.on_frame(frame);
      }
      const DeviceState device{Vec3(0, std::max(0.02 - 0.0002 * tick, -0.01), 0)};
      a = plain.step(device, 0.001 * tick), b = averaged.step(device, 0.001 * tick);
    }
    // Depth that rises by v per frame is drawn (1 - alpha) / alpha v too low.
    EXPECT_NEAR(a.proxy_W.y() - b.proxy_W.y(), 1.5 * speed / 30, 2e-5) << speed;
  }
}

}  // namespace
}  // namespace remote_touch::frame_average_test
