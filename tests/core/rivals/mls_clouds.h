// Points of smooth surfaces, and positions near them, for tests of moving least squares.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "core/rivals/mls_projection.h"
#include "tests/support/scenes.h"

namespace remote_touch::mls_clouds {

inline constexpr double kH = 0.0045;
inline constexpr double kPi = 3.14159265358979323846;
inline const Vec3 kNone = Vec3::Zero(), kUp = Vec3::UnitY();

inline Neighbourhood near_of(const PointCloud& cloud, double h = kH) {
  return scenes::neighbourhood(make_search(cloud), MlsProjection::kSupportInWidths * h);
}

// Normally distributed numbers; their bits need not be the same everywhere.
class Normals {
 public:
  explicit Normals(unsigned seed) : random_(seed) {}
  double next() { return distribution_(random_); }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> distribution_;
};

// A smooth surface over an irregular sample of x and z, with noise along y.
inline PointCloud bumps(unsigned seed, double noise_m = 0) {
  PointCloud cloud = scenes::random_cloud(4000, 0.04, seed);
  Normals noise(seed);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.y[i] = 0.002 * std::sin(cloud.x[i] / 0.012) * std::cos(cloud.z[i] / 0.015) + noise_m * noise.next();
  return cloud;
}

// Positions up to height_m from the plane y = 0, away from the border of bumps().
inline std::vector<Vec3> positions(int count, double height_m, unsigned seed) {
  const PointCloud cloud = scenes::random_cloud(count, 1, seed);
  std::vector<Vec3> list;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    list.push_back(cloud.point(i).cwiseProduct(Vec3(0.02, height_m, 0.02)));
  return list;
}

// A sphere around the origin: points of a Fibonacci lattice, about spacing_m apart.
inline PointCloud sphere(double radius_m, double spacing_m) {
  const int count = static_cast<int>(4 * kPi * radius_m * radius_m / (spacing_m * spacing_m));
  const double turn = kPi * (3 - std::sqrt(5.0));
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - y * y);
    cloud.append(radius_m * Vec3(r * std::cos(turn * i), y, r * std::sin(turn * i)));
  }
  return cloud;
}

}  // namespace remote_touch::mls_clouds
