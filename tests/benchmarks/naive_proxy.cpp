#include "tests/benchmarks/naive_proxy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch::naive {
namespace {

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
  double step = distance;
  for (const Vec3& x : points)
    if ((x - proxy_W).dot(direction) > 0)
      step = std::min(step, equations::first_hit(proxy_W, x, direction, p.contact_radius_m()).value_or(step));
  return step < distance ? Vec3(step * direction) : u;
}

// (4.5), (4.10)
Vec3 entrenched_step(const std::vector<Vec3>& points, const Vec3& proxy_W, const Vec3& normal,
                     const ProxyParameters& p) {
  double step = 0;
  for (const Vec3& x : points)
    if ((x - proxy_W).norm() < p.r1_m)
      step = std::max(step, equations::exit_distance(proxy_W, x, normal, p.contact_radius_m(), p.r1_m));
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
    if (distance > 0 && distance < p.r3_m)
      sum += e / distance * equations::weight(distance, p.r1_m, p.r3_m);  // (4.1)
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
