// Clouds and frames that tests and benchmarks share.
#pragma once

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "runners/evaluation/contract/contract_tests.h"

namespace remote_touch::scenes {

// The points are uniform in a cube around the origin. They are test data only: their bits need not be the
// same everywhere.
inline PointCloud random_cloud(int count, double half_width, unsigned seed) {
  std::mt19937 random(seed);
  const auto coordinate = [&] { return half_width * (random() / 2147483648.0 - 1.0); };
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    cloud.append({x, y, z});
  }
  return cloud;
}

// Compares bits and not values, so that a hole (NaN) equals itself.
inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}
inline bool same_points(const PointCloud& a, const PointCloud& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
inline bool same_clouds(const PointCloud& a, const PointCloud& b) {
  return same_points(a, b) && same_bits(a.nx, b.nx) && same_bits(a.ny, b.ny) && same_bits(a.nz, b.nz) &&
         a.colour == b.colour;
}

inline PointCloud cloud_of(const std::vector<Vec3>& points) {
  PointCloud cloud;
  for (const Vec3& p : points) cloud.append(p);
  return cloud;
}

// A random cloud with normals in all directions; every seventh point has none.
inline PointCloud cloud_with_normals(int count, double half_width, unsigned seed) {
  PointCloud cloud = random_cloud(count, half_width, seed);
  const PointCloud directions = random_cloud(count, 1, seed + 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 n = i % 7 == 0 ? Vec3(Vec3::Constant(std::nan(""))) : directions.point(i).normalized();
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  }
  return cloud;
}

// The points of a search in a ball, in padded columns.
inline GatheredPoints gathered(const NeighbourSearch& search, const Ball& ball = {Vec3::Zero(), 1e6},
                               const Kernels& with = kernels()) {
  GatheredPoints points;
  points.reserve(search.size(), search.has_fixture_radius(), search.has_stiffness());
  search.gather(ball, with, points);
  points.finish();
  return points;
}

inline Neighbourhood neighbourhood(std::shared_ptr<const NeighbourSearch> points, double reach_m) {
  Neighbourhood near(reach_m, kernels());
  near.set_points(std::move(points));
  return near;
}

inline ProxyRenderer renderer(const ProxyParameters& parameters = {}) {
  return ProxyRenderer(parameters, 1000, kernels());
}

}  // namespace remote_touch::scenes
