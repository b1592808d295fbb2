// Noise along the rays against its definition: growth with the distance, direction, correlation across the
// view and in time.
#include "scenarios/camera/ray_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/sensor_fault_scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::ray_noise_test {
namespace {

// Products of pairs over many frames: mean, and its standard deviation.
struct Correlation {
  double sum = 0, squares = 0, count = 0;
  void add(double product) { sum += product, squares += product * product, ++count; }
  void expect(double expected, const char* what) const {
    const double mean = sum / count, sd = std::sqrt((squares / count - mean * mean) / count);
    EXPECT_NEAR(mean, expected, 5 * sd) << what;
  }
};

PointCloud two_places(double x, double z, double dx, double dz) {
  PointCloud places;
  places.append({x, 0, z}), places.append({x + dx, 0, z + dz});
  return places;
}

TEST(RayNoise, PointsAndFramesAreIndependentWithoutCorrelation) {
  Correlation square, between_points, between_frames;
  const PointCloud places = two_places(0, 0, 0, 0);
  std::vector<double> last;
  for (int frame = 0; frame < 4000; ++frame) {
    const std::vector<double> n = standard_noise({0.01, 0, 0}, places, kKey, frame, scenes::kernels());
    square.add(n[0] * n[0]), between_points.add(n[0] * n[1]);
    if (frame > 0) between_frames.add(n[0] * last[0]);
    last = n;
  }
  square.expect(1, "variance");
  between_points.expect(0, "between points");
  between_frames.expect(0, "between frames");
}

// Returns the correlation of the noise at x and x + dx (in pitches), from the weights of the nodes around
// both.
double expected_correlation(double x, double dx) {
  const auto weight = [](double at, int node) { return std::max(0.0, 1 - std::abs(at - node)); };
  double product = 0, a = 0, b = 0;
  for (int node = -4; node <= 4; ++node) {
    product += weight(x, node) * weight(x + dx, node);
    a += weight(x, node) * weight(x, node), b += weight(x + dx, node) * weight(x + dx, node);
  }
  return product / std::sqrt(a * b);
}

TEST(RayNoise, IsCorrelatedAcrossTheViewAsItsLatticeSays) {
  constexpr double kPitch_m = 0.01;
  for (const double dx : {0.0, 0.3, 1.0, 1.6, 2.1}) {
    Correlation square, along_x, along_z;
    for (int frame = 0; frame < 4000; ++frame) {
      const std::vector<double> n = standard_noise(
          {0.01, kPitch_m, 0}, two_places(0.003, -0.007, kPitch_m * dx, 0), kKey, frame, scenes::kernels());
      const std::vector<double> m = standard_noise(
          {0.01, kPitch_m, 0}, two_places(-0.007, 0.003, 0, kPitch_m * dx), kKey, frame, scenes::kernels());
      square.add(n[1] * n[1]), along_x.add(n[0] * n[1]), along_z.add(m[0] * m[1]);
    }
    square.expect(1, "variance");
    along_x.expect(expected_correlation(0.3, dx), "x");
    along_z.expect(expected_correlation(0.3, dx), "z");
  }
}

// The correlation of two frames is m^lag over many rays, from the first frame on.
TEST(RayNoise, TheCorrelationOfFramesIsThePowerOfTheMemory) {
  PointCloud places;
  for (int i = 0; i < 20000; ++i) places.append({0, 0, 0});
  for (const double memory : {0.3, 0.5, 0.9, 0.99}) {
    std::vector<std::vector<double>> frames;
    for (int frame = 0; frame <= 70; ++frame)
      frames.push_back(standard_noise({0.01, 0, memory}, places, kKey, frame, scenes::kernels()));
    for (const auto& [first, lag] :
         {std::pair{0, 0}, {0, 1}, {9, 1}, {10, 0}, {31, 1}, {31, 2}, {40, 0}, {0, 10}, {15, 20}, {5, 64}}) {
      Correlation product;
      for (std::size_t i = 0; i < places.size(); ++i)
        product.add(frames[static_cast<std::size_t>(first)][i] *
                    frames[static_cast<std::size_t>(first + lag)][i]);
      product.expect(std::pow(memory, lag), "memory to the power of the lag");
    }
  }
}

// x_j - m x_(j-1) is new noise: it has the variance 1 - m^2, and knows nothing of the frames before.
TEST(RayNoise, RemembersNothingButTheFrameBefore) {
  PointCloud places;
  for (int i = 0; i < 5000; ++i) places.append({0, 0, 0});
  constexpr double kMemory = 0.8;
  std::vector<std::vector<double>> frames;
  for (int frame = 0; frame < 40; ++frame)
    frames.push_back(standard_noise({0.01, 0, kMemory}, places, kKey, frame, scenes::kernels()));
  Correlation variance, with_older;
  for (std::size_t j = 2; j < frames.size(); ++j)
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double added = frames[j][i] - kMemory * frames[j - 1][i];
      variance.add(added * added), with_older.add(added * frames[j - 2][i]);
    }
  variance.expect(1 - kMemory * kMemory, "variance of what is new");
  with_older.expect(0, "product with the frame before the last");
}

TEST(RayNoise, APositionHasTheSameNoiseInEveryCloud) {
  PointCloud alone, many = scenes::random_cloud(100, 0.3, 4);
  alone.append({0.0123, 0, -0.0456});
  many.append(alone.point(0));
  many.append(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  const RayNoise noise{0.01, 0.005, 0.3};
  const std::vector<double> a = standard_noise(noise, alone, kKey, 7, scenes::kernels());
  const std::vector<double> b = standard_noise(noise, many, kKey, 7, scenes::kernels());
  EXPECT_EQ(a[0], b[100]);
  EXPECT_TRUE(std::isnan(b[101]));
}

// Lattices of 39 million nodes, of the largest range of numbers, and of one million.
TEST(RayNoise, RefusesALatticeThatIsTooFineForTheCloud) {
  const PointCloud places = two_places(0, 0, 0.1, 0.1);
  EXPECT_HAS(refusal([&] {
               standard_noise({0.01, 1.6e-5, 0}, places, kKey, 0, scenes::kernels());
             }),
             "faults.ray_noise_correlation_m: needs a lattice of ");
  EXPECT_HAS(refusal([&] {
               standard_noise({0.01, 1e-7, 0}, places, kKey, 0, scenes::kernels());
             }),
             ": expected a larger value, for at most 16777216 nodes, or 0");
  EXPECT_EQ(standard_noise({0.01, 1e-4, 0}, places, kKey, 0, scenes::kernels()).size(), 2u);
}

TEST(SensorFaults, RayNoiseGrowsWithTheSquareOfTheDistanceAlongTheRays) {
  SensorFaults s;
  s.ray_noise.sigma_m = 0.002, s.view_direction = {0, -3, 0}, s.sensor_distance_m = 2;
  const auto clean = bare();
  const FaultySensor sensor = faulty(s);
  Correlation square;
  for (const int frame : {0, 20, 39}) {
    const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
    for (std::size_t i = 0; i < after.size(); ++i) {
      ASSERT_TRUE(after.x[i] == before.x[i] && after.z[i] == before.z[i]);
      const double distance = 2 - before.y[i];
      const double noise = (after.y[i] - before.y[i]) / (0.002 * distance * distance);
      square.add(noise * noise);
    }
  }
  square.expect(1, "variance in units of sigma distance^2");
  EXPECT_EQ(sensor.frame_count(), std::numeric_limits<int>::max()) << "noise goes on on a surface at rest";
}

TEST(SensorFaults, RayNoiseOfAnImageIsAlongTheRayOfEachPixel) {
  SensorFaults s;
  s.ray_noise.sigma_m = 0.002;
  const PointCloud before = camera()->cloud(0), after = faulty(s, camera()).cloud(0);
  const Vec3 eye = before.image->X_WC.translation();
  Correlation square;
  for (std::size_t i = 0; i < after.size(); i += 7) {
    if (!before.is_measured(i)) continue;
    const Vec3 ray = before.point(i) - eye, displacement = after.point(i) - before.point(i);
    ASSERT_LT(displacement.cross(ray).norm(), 1e-14);
    const double noise = displacement.dot(ray.normalized()) / (0.002 * ray.squaredNorm());
    square.add(noise * noise);
  }
  square.expect(1, "variance in units of sigma distance^2");
}

}  // namespace
}  // namespace remote_touch::ray_noise_test
