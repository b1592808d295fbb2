// The sensor models against their formulas: noise, steps, shadows and ranges; and their promises: pure
// functions, and the simple sensor is the depth camera.
#include "scenarios/simulated/depth_camera.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

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

// Mean and standard deviation of the measured depths minus z, over frames.
struct Statistics {
  double mean = 0, sd = 0;
};
Statistics errors(const DepthSensor& sensor, const SceneView& view, double z, int frames) {
  double sum = 0, squares = 0, count = 0;
  for (int frame = 0; frame < frames; ++frame)
    for (const double measured : sensor.measured_depth(view, frame).z_m)
      if (!std::isnan(measured)) sum += measured - z, squares += (measured - z) * (measured - z), ++count;
  return {sum / count, std::sqrt(squares / count - sum / count * sum / count)};
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

TEST(DepthSensor, ValuesBelowZeroAreThoseOfTheSensor) {
  DepthSensorSettings s;
  s.sensor = Kind::structured_light;
  EXPECT_EQ(triangulation(s).baseline_m, 0.075);
  EXPECT_EQ(triangulation(s).focal_px, 580);
  EXPECT_EQ(triangulation(s).step_px, 0.125);
  EXPECT_EQ(triangulation(s).window_px, 1);
  s.sensor = Kind::active_stereo;
  EXPECT_EQ(triangulation(s).baseline_m, 0.05);
  EXPECT_EQ(triangulation(s).focal_px, s.camera.focal_px);
  EXPECT_EQ(triangulation(s).noise_px, 0.08);
  EXPECT_EQ(triangulation(s).lateral_noise_px, 0);
  s.noise_px = 0, s.baseline_m = 0.055, s.window_px = 5, s.max_angle_deg = 70;
  EXPECT_EQ(triangulation(s).noise_px, 0);
  EXPECT_EQ(triangulation(s).baseline_m, 0.055);
  EXPECT_EQ(triangulation(s).window_px, 5);
  EXPECT_EQ(triangulation(s).max_angle_deg, 70);
  EXPECT_EQ(triangulation(s).max_disparity_px, 126);
}

TEST(DepthSensor, RefusesABaselineOfZero) {
  DepthSensorSettings s;
  EXPECT_EQ(validate(s), "");
  s.baseline_m = 0;
  EXPECT_NE(validate(s), "");
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
  const auto deviation = [](const DepthSensorSettings& s, double z_m) {
    const DepthSensor sensor = made(s);
    EXPECT_TRUE(sensor.noisy());
    const Triangulation t = triangulation(s);
    const double step_m = z_m * z_m * t.step_px / (t.focal_px * t.baseline_m);
    const auto depth = [&](int u) { return z_m + step_m * (double(u) / kWidth - 0.5); };
    const SceneView view = sensor.view(rows(depth), {}, {});
    double sum = 0, squares = 0, count = 0;
    for (int frame = 0; frame < 20; ++frame) {
      const DepthImage measured = sensor.measured_depth(view, frame);
      for (std::size_t i = 0; i < measured.z_m.size(); ++i) {
        const double error_m = measured.z_m[i] - depth(static_cast<int>(i) % kWidth);
        if (!std::isnan(error_m)) sum += error_m, squares += error_m * error_m, ++count;
      }
    }
    const double sd = std::sqrt(squares / count - sum / count * sum / count);
    EXPECT_NEAR(sum / count, 0, 0.1 * sd) << z_m;
    return sd;
  };
  for (const double focal_px : {290.0, 525.0, 580.0})
    for (const double z : kDepths) {
      DepthSensorSettings s = settings(Kind::structured_light);
      s.camera.focal_px = focal_px;
      EXPECT_NEAR(deviation(s, z), 1.43e-3 * z * z, 0.03 * 1.43e-3 * z * z) << focal_px << " " << z;
      s.axial_noise = AxialNoise::nguyen_2012;
      const double nguyen_m = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
      EXPECT_NEAR(deviation(s, z), nguyen_m, 0.03 * nguyen_m) << focal_px << " " << z;
    }
  for (const double z : kDepths) {
    const double stereo_m = 0.08 * z * z / (kFocal_px * 0.05);
    EXPECT_NEAR(deviation(settings(Kind::active_stereo), z), stereo_m, 0.05 * stereo_m) << z;
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
    EXPECT_NEAR(errors(sensor, view, z, 20).sd, expected, 0.05 * expected) << degrees;
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

TEST(DepthSensor, TheNoiseOfStereoIsCorrelatedOverItsWindow) {
  DepthSensorSettings s = settings(Kind::active_stereo);
  s.disparity_step_px = 0;
  const DepthSensor sensor = made(s);
  const SceneView view = sensor.view(wall(1), {}, {});
  std::vector<DepthImage> frames;
  for (int frame = 0; frame < 40; ++frame) frames.push_back(sensor.measured_depth(view, frame));
  const auto correlation = [&](int du, int dv) {
    double products = 0, squares = 0;
    for (const DepthImage& depth : frames)
      for (int v = 0; v + dv < kHeight; ++v)
        for (int u = 40; u + du < kWidth; ++u) {
          const double a = depth.z_m[pixel(u, v)] - 1, b = depth.z_m[pixel(u + du, v + dv)] - 1;
          products += a * b, squares += a * a;
        }
    return products / squares;
  };
  EXPECT_NEAR(correlation(1, 0), 6.0 / 7, 0.05);
  EXPECT_NEAR(correlation(0, 3), 4.0 / 7, 0.05);
  EXPECT_NEAR(correlation(2, 2), 25.0 / 49, 0.05);
  EXPECT_NEAR(correlation(7, 0), 0, 0.05);
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

TEST(DepthSensor, ListsItsParameters) {
  DepthSensorSettings s;
  for (const Parameter& parameter : parameters(s)) {
    const auto count = [&](const std::string& name) {
      const Parameters all = parameters(s);
      return std::count_if(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; });
    };
    EXPECT_EQ(count(parameter.name), 1) << parameter.name;
    EXPECT_FALSE(parameter.help.empty());
  }
}

}  // namespace
}  // namespace remote_touch::depth_sensor_test
