// The sensor models against their formulas: noise, steps, shadows and ranges; and their promises: pure
// functions, and the simple sensor is the depth camera.
#include "scenarios/simulated/depth_camera.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "core/points/noise.h"
#include "tests/support/scenes.h"

namespace remote_touch::depth_sensor_test {
namespace {

using Kind = DepthSensorKind;
constexpr int kWidth = 160, kHeight = 60;
constexpr double kFocal_px = 580, kRadians = 3.14159265358979 / 180;

DepthSensorSettings settings(Kind kind) {
  DepthSensorSettings s;
  s.camera = {.width = kWidth, .height = kHeight, .focal_px = kFocal_px};
  s.sensor = kind, s.max_disparity_px = 1000;
  return s;
}
DepthSensorSettings without_noise(Kind kind) {
  DepthSensorSettings s = settings(kind);
  s.noise_px = 0, s.disparity_step_px = 0, s.lateral_noise_px = 0;
  return s;
}
DepthSensor made(const DepthSensorSettings& s, std::uint64_t seed = 1) {
  return DepthSensor(s, NoiseKey{seed}, scenes::kernels());
}
// z(u) in every row.
template <class Depth>
DepthImage rows(const Depth& depth) {
  DepthImage image{kWidth, kHeight, {}};
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) image.z_m.push_back(depth(u));
  return image;
}
DepthImage wall(double z_m) {
  return rows([z_m](int) { return z_m; });
}
// A near surface left or right of column kWidth / 2, and a far one on the other side.
DepthImage step(bool is_near_on_the_right, double near_m, double far_m) {
  return rows([=](int u) { return (u >= kWidth / 2) == is_near_on_the_right ? near_m : far_m; });
}
std::size_t pixel(int u, int v) {
  return static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u);
}

// Standard deviation of the measured depths minus the ideal ones, over 20 frames. Their mean is 0.
double deviation(const DepthSensor& sensor, const SceneView& view) {
  double sum = 0, squares = 0, count = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const DepthImage measured = sensor.measured_depth(view, frame);
    for (std::size_t i = 0; i < measured.z_m.size(); ++i) {
      const double error_m = measured.z_m[i] - view.ideal.depth.z_m[i];
      if (!std::isnan(error_m)) sum += error_m, squares += error_m * error_m, ++count;
    }
  }
  const double sd = std::sqrt(squares / count - sum / count * sum / count);
  EXPECT_NEAR(sum / count, 0, 0.1 * sd);
  return sd;
}

constexpr double kDepths[] = {0.5, 0.8, 1.15, 1.6, 2.3};

TEST(DepthSensor, TheSimpleSensorIsTheDepthCamera) {
  DepthSensorSettings s = settings(Kind::simple);
  s.camera.camera_position_m = {0.1, 0.5, 0.2};
  const DepthCamera camera(s.camera, NoiseKey{1}, scenes::kernels());
  const auto cast = [](const Vec3& origin, const Vec3& ray) {
    return RayHit{((ray.x() > 0 ? 0.1 : 0) - origin.y()) / ray.y(), ray.x() > 0 ? 1u : 2u};
  };
  const IdealView ideal = camera.view(cast, true);
  const DepthSensor sensor = made(s);
  const SceneView view = sensor.view(ideal.depth, {}, ideal.colour);
  EXPECT_EQ(view.ideal.hole, ideal.hole);
  EXPECT_EQ(view.ideal.colour, ideal.colour);
  EXPECT_TRUE(sensor.pose().isApprox(camera.pose(), 0));
  EXPECT_TRUE(sensor.noisy());
  for (const int frame : {0, 5}) {
    const PointCloud expected = camera.measured(ideal, frame);
    const PointCloud cloud =
        cloud_from_depth(sensor.measured_depth(view, frame), sensor.intrinsics(), sensor.pose());
    EXPECT_TRUE(scenes::same_points(cloud, expected));
  }
}

TEST(DepthSensor, SettingsReplaceTheValuesOfTheSensor) {
  DepthSensorSettings s;
  s.sensor = Kind::active_stereo;
  EXPECT_EQ(triangulation(s).focal_px, s.camera.focal_px);
  EXPECT_EQ(triangulation(s).window_px, 7);
  EXPECT_EQ(triangulation(s).max_disparity_px, 126);
  s.noise_px = 0, s.baseline_m = 0.055, s.window_px = 5, s.max_angle_deg = 70;
  EXPECT_EQ(triangulation(s).noise_px, 0);
  EXPECT_EQ(triangulation(s).baseline_m, 0.055);
  EXPECT_EQ(triangulation(s).window_px, 5);
  EXPECT_EQ(triangulation(s).max_angle_deg, 70);
}

TEST(DepthSensor, RefusesAnImageOfAnotherSize) {
  const DepthSensor sensor = made(settings(Kind::active_stereo));
  EXPECT_THROW(sensor.view({10, 10, std::vector<double>(100)}, {}, {}), std::invalid_argument);
  EXPECT_THROW(sensor.view(wall(1), std::vector<double>(3), {}), std::invalid_argument);
}

// Khoshelham and Oude Elberink 2012, and Intel's formula for stereo. The published deviations are those of
// measured depths, rounding included. Structured light has the focal length of its own camera at any size of
// the image. The depths are drawn over a step of disparity, because the rounded value depends on the place in
// the step.
TEST(DepthSensor, TheNoiseOfDepthIsThatOfItsPublication) {
  const auto deviation_at = [](const DepthSensorSettings& s, double z_m) {
    const Triangulation t = triangulation(s);
    const double step_m = z_m * z_m * t.step_px / (t.focal_px * t.baseline_m);
    const DepthSensor sensor = made(s);
    EXPECT_TRUE(sensor.noisy());
    const auto depth = [&](int u) { return z_m + step_m * (double(u) / kWidth - 0.5); };
    return deviation(sensor, sensor.view(rows(depth), {}, {}));
  };
  for (const double focal_px : {290.0, 525.0, 580.0})
    for (const double z : kDepths) {
      DepthSensorSettings s = settings(Kind::structured_light);
      s.camera.focal_px = focal_px;
      EXPECT_NEAR(deviation_at(s, z), 1.43e-3 * z * z, 0.03 * 1.43e-3 * z * z) << focal_px << " " << z;
      s.axial_noise = AxialNoise::nguyen_2012;
      const double nguyen_m = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
      EXPECT_NEAR(deviation_at(s, z), nguyen_m, 0.03 * nguyen_m) << focal_px << " " << z;
    }
  for (const double z : kDepths) {
    const double stereo_m = 0.08 * z * z / (kFocal_px * 0.05);
    EXPECT_NEAR(deviation_at(settings(Kind::active_stereo), z), stereo_m, 0.05 * stereo_m) << z;
  }
}

TEST(DepthSensor, TheNoiseGrowsAtGrazingAngles) {
  DepthSensorSettings s = settings(Kind::structured_light);
  s.axial_noise = AxialNoise::nguyen_2012, s.disparity_step_px = 0;
  const DepthSensor sensor = made(s);
  for (const double degrees : {30.0, 60.0, 75.0, 79.0}) {
    const double z = 0.9, theta = degrees * kRadians, q = theta / (90 * kRadians - theta);
    const std::vector<double> cosine(kWidth * kHeight, -std::cos(theta));
    const SceneView view = sensor.view(wall(z), cosine, {});
    const double expected = 0.0012 + 0.0019 * 0.25 + 0.0001 / std::sqrt(z) * q * q;
    const double px_per_m = kFocal_px * 0.075 / (z * z);
    EXPECT_NEAR(view.noise_px[77], expected * px_per_m, 1e-9) << degrees;
    EXPECT_NEAR(view.lateral_noise_px[77], 0.8 + 0.035 * q, 1e-9) << degrees;
    EXPECT_NEAR(deviation(sensor, view), expected, 0.05 * expected) << degrees;
  }
}

TEST(DepthSensor, DisparitiesAreWholeSteps) {
  for (const auto& [kind, baseline_m, step_px] :
       {std::tuple{Kind::structured_light, 0.075, 0.125}, std::tuple{Kind::active_stereo, 0.05, 1.0 / 32}}) {
    DepthSensorSettings s = settings(kind);
    s.noise_px = 0, s.lateral_noise_px = 0;
    const DepthSensor sensor = made(s);
    EXPECT_FALSE(sensor.noisy());
    const DepthImage ideal = rows([](int u) { return 0.6 + 0.003 * u; });
    const DepthImage measured = sensor.measured_depth(sensor.view(ideal, {}, {}), 4);
    int found = 0;
    for (std::size_t i = 0; i < ideal.z_m.size(); ++i) {
      if (std::isnan(measured.z_m[i])) continue;
      const double steps = kFocal_px * baseline_m / measured.z_m[i] / step_px;
      EXPECT_NEAR(steps, std::round(steps), 1e-9);
      EXPECT_LE(std::abs(steps - kFocal_px * baseline_m / ideal.z_m[i] / step_px), 0.5 + 1e-9);
      ++found;
    }
    EXPECT_GT(found, kWidth * kHeight / 2);
  }
}

TEST(DepthSensor, TheShadowOfAnEdgeIsTheDifferenceOfTheDisparitiesWide) {
  for (const Kind kind : {Kind::structured_light, Kind::active_stereo}) {
    const double near_m = 0.7, far_m = 1.1, baseline_m = kind == Kind::active_stereo ? 0.05 : 0.075;
    const DepthSensor sensor = made(without_noise(kind));
    const SceneView view = sensor.view(step(true, near_m, far_m), {}, {});
    const DepthImage measured = sensor.measured_depth(view, 0);
    int lost = 0;
    for (int u = kWidth / 2 - 1; u > 0 && std::isnan(measured.z_m[pixel(u, 20)]); --u) ++lost;
    EXPECT_NEAR(lost, baseline_m * kFocal_px * (1 / near_m - 1 / far_m), 1);
    for (int u = kWidth / 2; u < kWidth; ++u)
      EXPECT_NEAR(measured.z_m[pixel(u, 20)], near_m, 1e-12) << "no shadow on the other side";
  }
}

TEST(DepthSensor, StereoHasABandWithoutDepthAtTheLeftBorder) {
  for (const double z : {0.8, 1.3}) {
    const DepthSensor stereo = made(without_noise(Kind::active_stereo));
    const DepthSensor projector = made(without_noise(Kind::structured_light));
    const DepthImage measured = stereo.measured_depth(stereo.view(wall(z), {}, {}), 0);
    for (int u = 0; u < kWidth; ++u)
      EXPECT_EQ(std::isnan(measured.z_m[pixel(u, 3)]), u < 0.05 * kFocal_px / z) << u;
    for (const double depth : projector.measured_depth(projector.view(wall(z), {}, {}), 0).z_m)
      EXPECT_NEAR(depth, z, 1e-12);
  }
}

TEST(DepthSensor, SurfacesThatAreTooNearTooFarOrGrazingHaveNoDepth) {
  DepthSensorSettings s = without_noise(Kind::structured_light);
  s.max_disparity_px = -1;  // 0.4 m
  const DepthSensor sensor = made(s);
  const auto is_measured = [&](double z, double degrees) {
    const std::vector<double> cosine(kWidth * kHeight, std::cos(degrees * kRadians));
    return !std::isnan(sensor.measured_depth(sensor.view(wall(z), cosine, {}), 0).z_m[pixel(80, 30)]);
  };
  EXPECT_FALSE(is_measured(0.399, 0));
  EXPECT_TRUE(is_measured(0.401, 0));
  EXPECT_TRUE(is_measured(2.999, 0));
  EXPECT_FALSE(is_measured(3.001, 0));
  EXPECT_TRUE(is_measured(1, 79.9));
  EXPECT_FALSE(is_measured(1, 80.1));
  EXPECT_FALSE(is_measured(std::numeric_limits<double>::quiet_NaN(), 0));
}

// Beside an edge a pixel at distance k measures the other side if its normal exceeds (k - 1/2) / sigma.
TEST(DepthSensor, TheLateralNoiseIsThatOfTheEdge) {
  DepthSensorSettings s = without_noise(Kind::structured_light);
  s.lateral_noise_px = 0.8;
  const DepthSensor sensor = made(s);
  EXPECT_TRUE(sensor.noisy());
  const SceneView view = sensor.view(step(false, 0.7, 1.1), {}, {});  // the near surface has no shadow here
  std::vector<double> crossed(kWidth);
  constexpr int kFrames = 40;
  for (int frame = 0; frame < kFrames; ++frame) {
    const DepthImage measured = sensor.measured_depth(view, frame);
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        const double z = measured.z_m[pixel(u, v)], own = u < kWidth / 2 ? 0.7 : 1.1;
        ASSERT_TRUE(std::abs(z - 0.7) < 1e-12 || std::abs(z - 1.1) < 1e-12) << z;
        crossed[static_cast<std::size_t>(u)] += std::abs(z - own) > 0.1;
      }
  }
  for (int u = 0; u < kWidth; ++u) {
    const int distance = u < kWidth / 2 ? kWidth / 2 - u : u - kWidth / 2 + 1;
    const double expected = 0.5 * std::erfc((distance - 0.5) / 0.8 / std::sqrt(2.0));
    const double tolerance = 5 * std::sqrt(expected / (kFrames * kHeight)) + 2e-3;
    EXPECT_NEAR(crossed[static_cast<std::size_t>(u)] / (kFrames * kHeight), expected, tolerance) << distance;
  }
}

// Its depth, its noise and whether it has a depth at all are those of the other side.
TEST(DepthSensor, APixelThatMeasuresTheOtherSideOfAnEdgeIsAsThere) {
  DepthSensorSettings s = settings(Kind::structured_light);
  s.disparity_step_px = 0;
  const DepthSensor sensor = made(s);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const SceneView before_nothing = sensor.view(step(false, 0.7, nothing), {}, {});
  const SceneView before_shadow = sensor.view(step(true, 0.7, 1.1), {}, {});
  constexpr int kEdge = kWidth / 2, kFrames = 20;
  int gained = 0, lost = 0, out_of_shadow = 0, into_shadow = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const DepthImage object = sensor.measured_depth(before_nothing, frame);
    const DepthImage shadow = sensor.measured_depth(before_shadow, frame);
    for (int v = 0; v < kHeight; ++v) {
      lost += std::isnan(object.z_m[pixel(kEdge - 1, v)]);
      into_shadow += std::isnan(shadow.z_m[pixel(kEdge, v)]);
      const double beside = object.z_m[pixel(kEdge, v)], in_shadow = shadow.z_m[pixel(kEdge - 1, v)];
      if (!std::isnan(beside)) {
        EXPECT_NEAR(beside, 0.7, 0.01);
        EXPECT_GT(std::abs(beside - 0.7), 1e-9) << "noise";
        ++gained;
      }
      if (!std::isnan(in_shadow)) {
        EXPECT_NEAR(in_shadow, 0.7, 0.01);
        ++out_of_shadow;
      }
    }
  }
  const double expected = 0.5 * std::erfc(0.5 / 0.8 / std::sqrt(2.0)) * kFrames * kHeight;
  for (const int count : {gained, lost, out_of_shadow, into_shadow})
    EXPECT_NEAR(count, expected, 5 * std::sqrt(expected));
}

// The neighbours of a pixel share all but one column of its window.
TEST(DepthSensor, TheNoiseOfStereoIsCorrelatedOverItsWindow) {
  DepthSensorSettings s = settings(Kind::active_stereo);
  s.disparity_step_px = 0;
  const DepthSensor sensor = made(s);
  const SceneView view = sensor.view(wall(1), {}, {});
  double products = 0, squares = 0;
  for (int frame = 0; frame < 40; ++frame) {
    const std::vector<double> z = sensor.measured_depth(view, frame).z_m;
    for (int v = 0; v < kHeight; ++v)
      for (int u = 40; u + 1 < kWidth; ++u) {
        const double a = z[pixel(u, v)] - 1, b = z[pixel(u + 1, v)] - 1;
        products += a * b, squares += a * a;
      }
  }
  EXPECT_NEAR(products / squares, 6.0 / 7, 0.05);
}

TEST(DepthSensor, MeasuredDepthsArePureFunctions) {
  for (const Kind kind : {Kind::structured_light, Kind::active_stereo}) {
    const DepthSensor sensor = made(settings(kind)), other = made(settings(kind), 2);
    const SceneView view = sensor.view(step(true, 0.7, 1.1), {}, {});
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const std::vector<double> third = sensor.measured_depth(view, 3).z_m;
    omp_set_num_threads(4);
    const SceneView again = sensor.view(step(true, 0.7, 1.1), {}, {});
    EXPECT_FALSE(scenes::same_bits(sensor.measured_depth(view, 4).z_m, third));
    EXPECT_TRUE(scenes::same_bits(sensor.measured_depth(again, 3).z_m, third));
    EXPECT_FALSE(scenes::same_bits(other.measured_depth(view, 3).z_m, third));
    omp_set_num_threads(threads);
  }
}

}  // namespace
}  // namespace remote_touch::depth_sensor_test

// The shadow of the second device, and noise that is averaged over a window.
namespace remote_touch::sensor_errors_test {
namespace {

constexpr double kFocal_px = 500, kBaseline_m = 0.08, kEdge_m = 0.02;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Positions in the plane of the row: x to the right, z forward.
using Point = Eigen::Vector2d;
double side(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}
bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

// The surfaces of a row as straight pieces in metres, each with its pixel.
struct Piece {
  Point from, to;
  int pixel;
};
std::vector<Piece> pieces(const std::vector<double>& z) {
  const auto point = [](double u, double depth) { return Point(u / kFocal_px * depth, depth); };
  std::vector<Piece> all;
  const int width = static_cast<int>(z.size());
  const auto connected = [&](int u) {
    return u >= 0 && u + 1 < width && std::abs(z[u] - z[u + 1]) <= kEdge_m;
  };
  for (int u = 0; u < width; ++u) {
    if (std::isnan(z[u])) continue;
    if (!connected(u - 1)) all.push_back({point(u - 0.5, z[u]), point(u, z[u]), u});
    all.push_back({point(u, z[u]), connected(u) ? point(u + 1, z[u + 1]) : point(u + 0.5, z[u]), u});
  }
  return all;
}

// A point is hidden if the way from it to the device meets a piece, other than its own two, or if the device
// is behind the surface to its right.
bool is_hidden(const std::vector<double>& z, const std::vector<Piece>& all, int u) {
  const Point p(u / kFocal_px * z[u], z[u]), device(kBaseline_m, 0);
  for (const Piece& piece : all) {
    if (piece.from == p) {
      if (side(p, piece.to, device) >= 0) return true;
    } else if (piece.to != p && piece.pixel > u && cross(p, device, piece.from, piece.to)) {
      return true;
    }
  }
  return false;
}

// One image of all rows: they are independent.
TEST(BaselineShadow, IsThatOfRaysToTheDevice) {
  constexpr int kColumns = 120, kRows = 300;
  std::mt19937 random(3);
  const auto uniform = [&] { return random() / 4294967296.0; };
  DepthImage image{kColumns, kRows, {}};
  for (int v = 0; v < kRows; ++v) {
    double depth = 1, slope = 0;
    for (int u = 0; u < kColumns; ++u) {
      if (uniform() < 0.08) depth = 0.5 + uniform(), slope = 0.016 * (uniform() - 0.5);
      if (uniform() < 0.05) slope = 0.036 * (uniform() - 0.5);
      depth = std::max(0.4, depth + slope);
      image.z_m.push_back(uniform() < 0.03 ? kNaN : depth + 1e-6 * uniform());
    }
  }
  const std::vector<char> shadow = baseline_shadow(image, kFocal_px * kBaseline_m, kEdge_m);
  int hidden = 0, seen = 0;
  for (int v = 0; v < kRows; ++v) {
    const auto first = image.z_m.begin() + v * kColumns;
    const std::vector<double> z(first, first + kColumns);
    const std::vector<Piece> all = pieces(z);
    for (int u = 0; u < kColumns; ++u) {
      if (std::isnan(z[u])) continue;
      const bool is_shadow = shadow[static_cast<std::size_t>(v * kColumns + u)] != 0;
      ASSERT_EQ(is_shadow, is_hidden(z, all, u)) << v << " " << u;
      (is_shadow ? hidden : seen) += 1;
    }
  }
  EXPECT_GT(hidden, 2000);
  EXPECT_GT(seen, 2000);
}

// A window of one pixel is the noise of the stream.
TEST(WindowNoise, TheSumsAreThoseOfTheWindow) {
  constexpr int kWidth = 60, kHeight = 50;
  const NoiseStream stream = noise_stream(NoiseKey{7}, NoiseUse::depth, 5);
  for (const int window : {1, 4, 7}) {
    const int columns = kWidth + window - 1, rows = kHeight + window - 1;
    const auto count = static_cast<std::size_t>(columns * rows);
    std::vector<std::uint32_t> index(count);
    std::iota(index.begin(), index.end(), 0u);
    std::vector<double> x(count), y(count), z(count);
    scenes::kernels().noise.normals(stream, index.data(), count, x.data(), y.data(), z.data());
    const WindowNoise n = window_noise(kWidth, kHeight, window, true, stream, scenes::kernels());
    for (int v = 0; v < kHeight; ++v)
      for (int u = 0; u < kWidth; ++u) {
        double sum = 0;
        for (int j = 0; j < window; ++j)
          for (int i = 0; i < window; ++i) sum += x[static_cast<std::size_t>((v + j) * columns + u + i)];
        const auto pixel = static_cast<std::size_t>(v * kWidth + u);
        ASSERT_NEAR(n.averaged[pixel], sum / window, 1e-14) << window;
        ASSERT_EQ(n.across[pixel], y[static_cast<std::size_t>(v * columns + u)]);
        ASSERT_EQ(n.down[pixel], z[static_cast<std::size_t>(v * columns + u)]);
      }
  }
}

}  // namespace
}  // namespace remote_touch::sensor_errors_test
