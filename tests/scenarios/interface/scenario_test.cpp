#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

#include "scenarios/camera/camera_scene.h"
#include "scenarios/synthetic/flat_grid.h"
#include "scenarios/synthetic/listed_points.h"
#include "scenarios/synthetic/moving_lift.h"
#include "scenarios/synthetic/triangle_wave.h"
#include "tests/support/scenes.h"

namespace remote_touch::scenario_test {
namespace {

const NoiseKey kKey{1, 2, 3};

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, kKey, scenes::kernels());
}

// Compares bits and not values, so that a hole (NaN) equals itself.
bool same_bits(const PointCloud& a, const PointCloud& b) {
  const auto same = [](const std::vector<double>& c, const std::vector<double>& d) {
    return c.size() == d.size() && std::memcmp(c.data(), d.data(), c.size() * sizeof(double)) == 0;
  };
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

using Found = std::tuple<std::uint32_t, double, double, double>;  // number and position of a point

std::vector<Found> gathered(const NeighbourSearch& search, const Ball& ball) {
  GatheredPoints out;
  out.reserve(search.size(), false, false);
  search.gather(ball, scenes::kernels(), out);
  out.finish();
  const PointsView view = out.view();
  std::vector<Found> found;
  for (std::size_t i = 0; i < out.size(); ++i)
    found.push_back({out.index()[i], view.x[i], view.y[i], view.z[i]});
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Found> expected(const PointCloud& cloud, const Ball& ball) {
  std::vector<Found> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 e = cloud.point(i) - ball.centre;
    if (e.x() * e.x() + e.y() * e.y() + e.z() * e.z() <= ball.radius * ball.radius)
      found.push_back({static_cast<std::uint32_t>(i), cloud.x[i], cloud.y[i], cloud.z[i]});
  }
  return found;
}

// A frame has the same bits if another object computes it, in another order.
template <class Made>
void expect_pure_frames(const typename Made::Settings& settings, const std::vector<int>& frames) {
  const Made one = made<Made>(settings), other = made<Made>(settings);
  std::vector<PointCloud> clouds;
  for (const int frame : frames) clouds.push_back(one.cloud(frame));
  for (std::size_t i = frames.size(); i-- > 0;) {
    EXPECT_TRUE(same_bits(other.cloud(frames[i]), clouds[i])) << frames[i];
    if (i > 0) {
      EXPECT_FALSE(same_bits(clouds[i], clouds[i - 1])) << "frames differ";
    }
    const Vec3 middle = clouds[i].point(clouds[i].size() / 3);
    const Ball ball{middle.allFinite() ? middle : Vec3::Zero(), 0.02};
    const auto found = gathered(*other.points(frames[i]), ball);
    EXPECT_FALSE(found.empty());
    EXPECT_EQ(found, expected(clouds[i], ball)) << "points() is cloud()";
  }
}

TEST(Scenario, FramesArePure) {
  FlatGrid::Settings flat;
  flat.noise_sigma_m = 0.001;
  expect_pure_frames<FlatGrid>(flat, {0, 1, 5, 1000});
  expect_pure_frames<MovingLift>({}, {0, 1, 15, 25});
  TriangleWave::Settings wave;
  wave.noise_sigma_m = 0.001;
  expect_pure_frames<TriangleWave>(wave, {0});
  expect_pure_frames<CameraScene>({}, {0, 1, 7});
}

TEST(FlatGrid, PointsLieOnACentredGrid) {
  FlatGrid::Settings s;
  s.grid = {5, 3, 0.01, 0.25, -0.5};
  const PointCloud cloud = made<FlatGrid>(s).cloud(0);
  ASSERT_EQ(cloud.size(), 15u);
  EXPECT_LT((cloud.point(0) - Vec3(-0.0175, 0, -0.015)).norm(), 1e-17);
  EXPECT_LT((cloud.point(4) - Vec3(0.0225, 0, -0.015)).norm(), 1e-17);
  EXPECT_LT((cloud.point(14) - Vec3(0.0225, 0, 0.005)).norm(), 1e-17);
}

TEST(FlatGrid, NoiseIsRedrawnOrKept) {
  FlatGrid::Settings s;
  s.noise_sigma_m = 0.002;
  EXPECT_GT(made<FlatGrid>(s).frame_count(), 1000000);
  s.redraw_noise = false;
  EXPECT_EQ(made<FlatGrid>(s).frame_count(), 1);
  EXPECT_TRUE(same_bits(made<FlatGrid>(s).cloud(0), made<FlatGrid>(s).cloud(3)));
  double squares = 0;
  for (const double y : made<FlatGrid>(s).cloud(0).y) squares += y * y;
  EXPECT_NEAR(std::sqrt(squares / 1e4), 0.002, 5 * 0.002 / std::sqrt(2e4));  // standard error for 10^4 draws
}

// Noise is drawn on demand here. The oracle draws all of it and tests every point.
TEST(MovingLift, LazyPointsAreTheCloudBitForBit) {
  std::mt19937 random(1);
  for (const double sigma : {0.0, 0.003, 0.015}) {
    MovingLift::Settings s;
    s.noise_sigma_m = sigma;
    const MovingLift lift = made<MovingLift>(s);
    for (const int frame : {0, 14, 25}) {
      const PointCloud cloud = lift.cloud(frame);
      const double y = lift.surface_height(0, 0, lift.captured_s(frame));
      const PointCloud at = scenes::random_cloud(60, 1, static_cast<unsigned>(frame));
      std::vector<Ball> balls;
      for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3 far(0.17 * at.x[i], y + 0.1 * at.y[i], 0.17 * at.z[i]);  // beyond the grid's edge at 0.149
        const Vec3 near(0.03 * at.x[i], y + (0.01 + 3 * sigma) * at.y[i], 0.03 * at.z[i]);
        balls.push_back({i % 2 == 0 ? far : near, 0.002 + 0.0003 * static_cast<double>(i)});
        balls.push_back({balls.back().centre + Vec3(0.001, 0.0002, -0.001), 0.01});  // a proxy moves a little
      }
      // The point that the noise has moved highest: only a bound that no normal variate exceeds finds it.
      const auto highest = std::max_element(cloud.y.begin(), cloud.y.end()) - cloud.y.begin();
      balls.push_back({cloud.point(static_cast<std::size_t>(highest)), 1e-5});
      const auto search = lift.points(frame);
      std::size_t total = 0, empty = 0;
      for (int round = 0; round < 2; ++round) {
        for (const Ball& ball : balls) {
          const auto want = expected(cloud, ball);
          ASSERT_EQ(gathered(*search, ball), want) << sigma << ", " << ball.centre.transpose();
          total += want.size(), empty += want.empty();
        }
        std::shuffle(balls.begin(), balls.end(), random);
      }
      EXPECT_GT(total, 2000u);
      EXPECT_GT(empty, 5u);
    }
  }
}

TEST(MovingLift, HeightsFollowTheSpeeds) {
  MovingLift::Settings s;
  s.noise_sigma_m = 0;
  const MovingLift lift = made<MovingLift>(s);
  ASSERT_EQ(lift.frame_count(), 26);
  double v = 0.1, y = -0.05;
  for (int j = 0; j < lift.frame_count(); ++j) {
    if (j > 15) v += 3.0 / 30;
    if (j > 0) y += v / 30;
    // The time of a frame is rounded, and the plane moves a little within the rounding error.
    EXPECT_NEAR(lift.surface_height(0, 0, lift.captured_s(j)), y, 1e-15) << j;
    EXPECT_NEAR(lift.cloud(j).y[17], y, 1e-15) << j;
    const double between = lift.surface_height(0, 0, lift.captured_s(j) + 0.25 / 30);
    const double next_v = j >= 15 ? v + 0.1 : v;
    // The surface follows the parabola of the acceleration, which begins one update before the rise ends.
    const double sag = j >= 14 ? 0.5 * 0.25 * 0.75 * 3 / 900 : 0;
    EXPECT_NEAR(between, j == 25 ? y : y + 0.25 * next_v / 30 - sag, 1e-15) << j;
    // The truth that a renderer is judged by is the newest frame's plane.
    EXPECT_NEAR(lift.signed_distance({0, 0.01, 0}, lift.captured_s(j)), 0.01 - y, 1e-15) << j;
    EXPECT_NEAR(lift.signed_distance({0, -1, 0}, lift.captured_s(j) + 0.9 / 30), -1 - y, 1e-15) << j;
  }
  EXPECT_NEAR(y, 10 * 0.1 / 30 + 3.0 * 10 * 11 / 2 / 900, 1e-15);  // closed form of the sum
  EXPECT_NEAR(lift.surface_height(0, 0, 100), y, 1e-15);
}

// Corners half a period apart, alternately below and above by an amplitude that grows along the grid.
double wave_height(double x) {
  const double length = 299 * 0.0015, place = std::clamp((x + 0.5 * length) / 0.03, 0.0, length / 0.03);
  const int k = static_cast<int>(place);
  const auto corner = [&](int i) { return (i % 2 == 1 ? 0.015 : -0.015) * std::min(1.0, i * 0.03 / length); };
  return corner(k) + (place - k) * (corner(k + 1) - corner(k));
}

TEST(TriangleWave, RefusesAGridOfOneColumn) {
  TriangleWave::Settings settings;
  EXPECT_EQ(validate(settings), "");
  settings.grid.columns = 1;
  EXPECT_EQ(validate(settings), "columns = 1: expected 2 or more, because the wave runs along x");
}

TEST(TriangleWave, SignedDistanceIsToTheStraightFlanks) {
  const TriangleWave wave = made<TriangleWave>();
  EXPECT_NEAR(wave.surface_height(-149.5 * 0.0015 + 0.09, 1, 0), 0.015 * 0.09 / (299 * 0.0015), 1e-15);
  const double end = 149.5 * 0.0015, spacing = 2e-5;
  const PointCloud at = scenes::random_cloud(200, 1, 1);
  int below = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3 p(0.22 * at.x[i], 0.025 * at.y[i], 0.07 * at.z[i]);
    double squared = std::numeric_limits<double>::infinity();
    for (double x = -end; x <= end; x += spacing)
      squared = std::min(squared, std::pow(x - p.x(), 2) + std::pow(wave_height(x) - p.y(), 2));
    const double got = wave.signed_distance(p, 0);
    EXPECT_NEAR(wave.surface_height(p.x(), p.z(), 0), wave_height(p.x()), 1e-15);
    EXPECT_EQ(got < 0, p.y() < wave_height(p.x()));
    // The flanks rise by less than 1: samples are at most 1.5 spacings apart along them.
    EXPECT_LE(std::abs(got), std::sqrt(squared) + 1e-15);
    EXPECT_GE(std::sqrt(got * got + 2.25 * spacing * spacing), std::sqrt(squared) - 1e-15);
    below += got < 0;
  }
  EXPECT_GT(below, 50);
  EXPECT_TRUE(std::isnan(wave.signed_distance({0, -0.05, 0.08}, 0))) << "beside the cloud, along z";
  EXPECT_TRUE(std::isnan(wave.signed_distance({end + 1, -0.05, 0}, 0))) << "and along x";
  EXPECT_GT(wave.signed_distance({end + 0.01, 0.05, 0.08}, 0), 0);
}

// A position below the plane but beside the cloud has passed through no surface. Single points have no sides.
TEST(Scenario, HasNoBackBesideItsPoints) {
  const FlatGrid flat = made<FlatGrid>();  // 100 x 100 points, 1.5 mm apart
  const double border = 49.5 * 0.0015;
  for (const Vec3& p : {Vec3(border, -0.01, 0), Vec3(0, -0.01, -border)})
    EXPECT_EQ(flat.signed_distance(p, 0), -0.01);
  for (const Vec3& p : {Vec3(border + 1e-6, -0.01, 0), Vec3(0, -0.01, -border - 1e-6)})
    EXPECT_TRUE(std::isnan(flat.signed_distance(p, 0)));
  EXPECT_EQ(flat.signed_distance({1, 0.01, 1}, 0), 0.01);
  const MovingLift lift = made<MovingLift>();  // 200 x 200 points
  EXPECT_TRUE(std::isnan(lift.signed_distance({99.5 * 0.0015 + 1e-6, -1, 0}, 0)));
  EXPECT_LT(lift.signed_distance({99.5 * 0.0015, -1, 0}, 0), -0.9);
  const ListedPoints points = made<ListedPoints>();
  for (const double y : {0.01, 0.0, -0.01}) EXPECT_TRUE(std::isnan(points.signed_distance({0, y, 0}, 0)));
}

// Depth along the optical axis. The camera looks from (0.3, 0.6) to (0, 0.02) in the (x, y) plane.
const Vec3 kForward = Vec3(-0.3, -0.58, 0).normalized();
double axis_depth(const Vec3& p) {
  return (p - Vec3(0.3, 0.6, -0.02)).dot(kForward);
}
std::size_t pixel(int u, int v) {
  return static_cast<std::size_t>(v) * 640 + static_cast<std::size_t>(u);
}

CameraScene camera(double noise, double quantisation) {
  CameraScene::Settings s;
  s.camera.noise_per_m = noise, s.camera.quantisation_per_m = quantisation;
  return made<CameraScene>(s);
}

TEST(CameraScene, TableIsSeenAtItsDistance) {
  const CameraScene scene = camera(0, 0);
  const PointCloud cloud = scene.cloud(0);
  // The axis passes between ramp and box. A row looks down by its tangent (v - 239.5) / 525.
  for (const int v : {200, 239, 240, 300})
    for (const int u : {310, 320, 335}) {
      const double down = (v - 239.5) / 525;
      const double depth = 0.6 * std::sqrt(0.3 * 0.3 + 0.58 * 0.58) / (0.58 + 0.3 * down);
      EXPECT_NEAR(scene.true_depth().z_m[pixel(u, v)], depth, 1e-14) << u << " " << v;
      EXPECT_NEAR(cloud.y[pixel(u, v)], 0, 1e-14);
      EXPECT_NEAR(cloud.z[pixel(u, v)], -0.02 - (u - 319.5) / 525 * depth, 1e-14) << "z is to the left";
    }
}

TEST(CameraScene, NoiseFreePointsLieOnTheSurfaceInSight) {
  const CameraScene scene = camera(0, 0);
  const PointCloud cloud = scene.cloud(0);
  int on_solids = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    if (std::isnan(cloud.x[i])) continue;
    const Vec3 p = cloud.point(i);
    ASSERT_LT(std::abs(scene.signed_distance(p, 0)), 1e-12) << p.transpose();
    for (const double fraction : {0.7, 0.9, 0.99, 0.999})
      ASSERT_GT(scene.signed_distance(Vec3(0.3, 0.6, -0.02) + fraction * (p - Vec3(0.3, 0.6, -0.02)), 0), 0);
    on_solids += p.y() > 0.001;
  }
  EXPECT_GT(on_solids, 5000);
}

TEST(CameraScene, DepthIsQuantisedInWholeDisparities) {
  const double step = 0.00285;
  const CameraScene scene = camera(0, step);
  const PointCloud cloud = scene.cloud(0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::isnan(cloud.x[i])) continue;
    const double z = axis_depth(cloud.point(i)), level = 1 / (step * z);
    ASSERT_NEAR(level, std::round(level), 1e-9);
    // Half a disparity is half a step of 0.00285 z^2, to first order in step z.
    ASSERT_LT(std::abs(z - scene.true_depth().z_m[i]), 0.5 * step * z * z * (1 + step * z));
  }
}

TEST(CameraScene, NoiseGrowsWithTheSquareOfTheDepth) {
  const double noise = 0.0012;
  const CameraScene scene = camera(noise, 0);
  const PointCloud cloud = scene.cloud(4);
  for (const bool far : {false, true}) {
    double sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const double truth = scene.true_depth().z_m[i];
      if (std::isnan(cloud.x[i]) || (truth > 0.7) != far) continue;
      const double error = (axis_depth(cloud.point(i)) - truth) / (noise * truth * truth);
      sum += error, squares += error * error, ++count;
    }
    ASSERT_GT(count, 30000);
    EXPECT_NEAR(sum / count, 0, 5 / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count), 1, 5 / std::sqrt(2 * count));
  }
}

// An edge runs between two pixels. Pixels within hole_px = 2 of it have no depth; all pixels farther away
// have one.
TEST(CameraScene, HolesAreOnlyAlongDepthEdges) {
  const CameraScene scene = made<CameraScene>();
  const std::vector<double>& truth = scene.true_depth().z_m;
  const PointCloud cloud = scene.cloud(0);
  std::vector<double> to_edge(truth.size(), 10);
  const auto mark = [&](double u, double v) {
    for (int y = std::max(0, static_cast<int>(v) - 4); y <= std::min(479, static_cast<int>(v) + 4); ++y)
      for (int x = std::max(0, static_cast<int>(u) - 4); x <= std::min(639, static_cast<int>(u) + 4); ++x)
        to_edge[pixel(x, y)] = std::min(to_edge[pixel(x, y)], std::max(std::abs(x - u), std::abs(y - v)));
  };
  for (int v = 0; v < 479; ++v)
    for (int u = 0; u < 639; ++u) {
      const double z = truth[pixel(u, v)];
      if (std::abs(z - truth[pixel(u + 1, v)]) > 0.02) mark(u + 0.5, v);
      if (std::abs(z - truth[pixel(u, v + 1)]) > 0.02) mark(u, v + 0.5);
    }
  int holes = 0, valid = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int missing = std::isnan(cloud.x[i]) + std::isnan(cloud.y[i]) + std::isnan(cloud.z[i]);
    EXPECT_TRUE(missing == 0 || missing == 3);
    EXPECT_TRUE(to_edge[i] > 2 || missing) << "a point beside an edge: " << i;
    EXPECT_TRUE(to_edge[i] <= 2 || !missing || std::isnan(truth[i])) << "a hole away from edges: " << i;
    holes += missing && std::isfinite(truth[i]), valid += !missing;
  }
  EXPECT_GT(holes, 500);
  EXPECT_GT(valid, 0.8 * 640 * 480);
}

}  // namespace
}  // namespace remote_touch::scenario_test
