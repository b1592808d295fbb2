#include "tests/benchmarks/naive_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "core/geometry/camera.h"
#include "tests/support/scenes.h"

namespace remote_touch::naive {

double psi(double r, const ProxyParameters& p) {
  if (r <= p.r1_m) return 1;
  if (r >= p.r3_m) return 0;
  const double t = (r - p.r1_m) / (p.r3_m - p.r1_m);
  const double q = 1 - t;
  return q * q * q * q * (4 * t + 1);
}

bool roots(const Vec3& point, const Vec3& from, const Vec3& direction, double radius, double& near,
           double& far) {
  const Vec3 e = point - from;
  const double along = e.dot(direction);
  const double rest = radius * radius - (e - along * direction).squaredNorm();
  if (rest < 0) return false;
  near = along - std::sqrt(rest), far = along + std::sqrt(rest);
  return true;
}

Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p) {
  const double height = u.dot(normal);
  const Vec3 goal = height < 0 ? Vec3(u - height * normal) : u;
  const double distance = goal.norm();
  if (distance == 0) return Vec3::Zero();
  const double length = distance < p.r1_m ? p.gamma * distance : p.xi * p.r1_m;
  return length * goal / distance;
}

Step proxy_step(const std::vector<Vec3>& points, const Vec3& proxy_W, const Vec3& hip_W,
                const Vec3& previous_normal, const ProxyParameters& p) {
  Step out;
  out.nearest_distance_m = std::numeric_limits<double>::infinity();
  Vec3 sum = Vec3::Zero();
  for (const Vec3& x : points) {
    const Vec3 e = proxy_W - x;
    const double distance = e.norm();
    if (distance < out.nearest_distance_m) out.nearest_distance_m = distance;
    if (distance > 0 && distance < p.r3_m) sum += e / distance * psi(distance, p);  // (4.1)
  }
  const double length = sum.norm();
  out.normal = length > 1e-10 ? Vec3(sum / length) : previous_normal;
  take_step(points, proxy_W, hip_W - proxy_W, p, out);
  return out;
}

std::vector<Vec3> points_of(const PointCloud& cloud) {
  std::vector<Vec3> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.point(i));
  return points;
}

std::vector<std::uint32_t> points_within(const PointCloud& cloud, const Ball& ball) {
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double dx = cloud.x[i] - ball.centre.x(), dy = cloud.y[i] - ball.centre.y(),
                 dz = cloud.z[i] - ball.centre.z();
    const double reach = ball.radius + (cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i]);
    if (dx * dx + dy * dy + dz * dz <= reach * reach) found.push_back(static_cast<std::uint32_t>(i));
  }
  return found;
}

PointCloud wave_image(double distance_m) {
  const CameraIntrinsics camera{640, 480, 525, 525, 319.5, 239.5};
  DepthImage depth{camera.width, camera.height, {}};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u)
      depth.z_m.push_back(distance_m + 0.01 * std::sin(0.03 * u) + 0.005 * std::sin(0.05 * v));
  return cloud_from_depth(depth, camera, RigidTransform::Identity());
}

namespace {

constexpr double kQueryRadius_m = 0.01;
constexpr int kQueries = 512;

// Centres are points of the middle of a cloud with rows of that width.
std::vector<Ball> jumping_balls(const PointCloud& cloud, int width) {
  const int height = static_cast<int>(cloud.size()) / width;
  std::mt19937 random(1);
  const auto within_middle = [&](int count) {
    return count / 6 + static_cast<int>(random() % (count * 2 / 3));
  };
  std::vector<Ball> balls;
  while (balls.size() < kQueries) {
    const int u = within_middle(width), v = within_middle(height);
    const Vec3 centre = cloud.point(static_cast<std::size_t>(v) * width + u);
    if (centre.allFinite()) balls.push_back({centre, kQueryRadius_m});
  }
  return balls;
}

std::vector<Ball> sliding_on_grid() {
  std::vector<Ball> balls;
  balls.reserve(kQueries);
  for (int i = 0; i < kQueries; ++i) balls.push_back({Vec3(-0.025 + 1e-4 * i, 0, 3e-5 * i), kQueryRadius_m});
  return balls;
}

// Returns the row with the fewest holes on its right half, because a recorded image has whole regions without
// depth.
int measured_row(const PointCloud& cloud, const CameraIntrinsics& camera) {
  int best = 0, max = -1;
  for (int v = camera.height / 3; v < 2 * camera.height / 3; ++v) {
    int measured = 0;
    for (int u = camera.width / 2; u < camera.width; ++u)
      measured += std::isfinite(cloud.z[static_cast<std::size_t>(v) * camera.width + u]) ? 1 : 0;
    if (measured > max) best = v, max = measured;
  }
  return best;
}

// The surface continues over a hole at the depth of the last measured pixel.
std::vector<Ball> sliding_on_image(const PointCloud& cloud, const CameraIntrinsics& camera) {
  const int row = measured_row(cloud, camera);
  double z = 0;
  const auto depth_at = [&](double u) {
    const double here = cloud.z[static_cast<std::size_t>(row) * camera.width + std::lround(u)];
    if (std::isfinite(here)) z = here;
    return z;
  };
  for (int u = camera.width - 1; u > camera.width / 2; --u) depth_at(u);  // it gives z a first depth
  std::vector<Ball> balls;
  balls.reserve(kQueries);
  double u = camera.width / 2.0;
  for (int i = 0; i < kQueries; ++i) {
    balls.push_back({unproject(camera, u, row, depth_at(u)), kQueryRadius_m});
    u += 1e-4 * camera.fx / z;
  }
  return balls;
}

Queries with_expected(Queries queries) {
  for (const Ball& ball : queries.balls) queries.expected.push_back(points_within(queries.cloud, ball));
  return queries;
}

const char* suffix(Centres centres) {
  return centres == Centres::slide ? "_slide" : "_jump";
}

}  // namespace

Queries on_grid(Centres centres) {
  constexpr int kWidth = 100;
  Queries queries{std::string("grid") + suffix(centres), scenes::flat_grid(kWidth)};
  queries.balls = centres == Centres::slide ? sliding_on_grid() : jumping_balls(queries.cloud, kWidth);
  return with_expected(std::move(queries));
}

Queries on_image(const std::string& name, PointCloud cloud, Centres centres) {
  Queries queries{name + suffix(centres), std::move(cloud)};
  const CameraIntrinsics& camera = queries.cloud.image->camera;
  queries.balls = centres == Centres::slide ? sliding_on_image(queries.cloud, camera)
                                            : jumping_balls(queries.cloud, camera.width);
  return with_expected(std::move(queries));
}

}  // namespace remote_touch::naive
