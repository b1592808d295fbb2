#include "tests/benchmarks/naive_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch::naive {
namespace {

// (4.2)
double psi(double r, const ProxyParameters& p) {
  if (r <= p.r1_m) return 1;
  if (r >= p.r3_m) return 0;
  const double t = (r - p.r1_m) / (p.r3_m - p.r1_m);
  const double q = 1 - t;
  return q * q * q * q * (4 * t + 1);
}

// Both roots of (4.9), (4.10) for one point, from its foot on the ray. The function returns false if there is
// no real root.
bool roots(const Vec3& point, const Vec3& from, const Vec3& direction, double radius, double& near,
           double& far) {
  const Vec3 e = point - from;
  const double along = e.dot(direction);
  const double rest = radius * radius - (e - along * direction).squaredNorm();
  if (rest < 0) return false;
  near = along - std::sqrt(rest), far = along + std::sqrt(rest);
  return true;
}

// (4.6), (4.7), (4.11), (4.12), with u = HIP - P.
Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p) {
  const double height = u.dot(normal);
  const Vec3 goal = height < 0 ? Vec3(u - height * normal) : u;
  const double distance = goal.norm();
  if (distance == 0) return Vec3::Zero();
  const double length = distance < p.r1_m ? p.gamma * distance : p.xi * p.r1_m;
  return length * goal / distance;
}

// (4.4), (4.9)
Vec3 free_step(const std::vector<Vec3>& points, const Vec3& proxy_W, const Vec3& u,
               const ProxyParameters& p) {
  const double distance = u.norm();
  if (distance == 0) return Vec3::Zero();
  const Vec3 direction = u / distance;
  double step = distance, near = 0, far = 0;
  for (const Vec3& x : points)
    if ((x - proxy_W).dot(direction) > 0 && roots(x, proxy_W, direction, p.contact_radius_m(), near, far) &&
        near > 0)
      step = std::min(step, near);
  return step < distance ? Vec3(step * direction) : u;
}

// (4.5), (4.10)
Vec3 entrenched_step(const std::vector<Vec3>& points, const Vec3& proxy_W, const Vec3& normal,
                     const ProxyParameters& p) {
  double step = 0, near = 0, far = 0;
  for (const Vec3& x : points)
    if ((x - proxy_W).norm() < p.r1_m && roots(x, proxy_W, normal, p.contact_radius_m(), near, far))
      step = std::max(step, far);
  return step * normal;
}

}  // namespace

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
  if (out.nearest_distance_m < p.r1_m) {
    out.state = ContactState::entrenched;
    out.step = naive::entrenched_step(points, proxy_W, out.normal, p);
  } else if (out.nearest_distance_m <= p.r2_m) {
    out.state = ContactState::contact;
    out.step = naive::contact_step(out.normal, hip_W - proxy_W, p);
  } else {
    out.step = naive::free_step(points, proxy_W, hip_W - proxy_W, p);
  }
  return out;
}

std::vector<Vec3> points_of(const PointCloud& cloud) {
  std::vector<Vec3> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.point(i));
  return points;
}

}  // namespace remote_touch::naive
