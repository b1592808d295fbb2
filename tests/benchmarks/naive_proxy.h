// The reference of the benchmarks: the method written plainly from its equations, over all points, in double
// precision and without the kernels. The file also makes the clouds on which both implementations run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/dissertation/proxy/proxy_step.h"
#include "core/geometry/point_cloud.h"
#include "core/rendering/renderer.h"
#include "core/search/neighbour_search.h"

namespace remote_touch::naive {

// A point without a region.
inline const Vec3& place_of(const Vec3& point) {
  return point;
}
inline double region_radius_of(const Vec3&) {
  return 0;
}

struct Step {
  ContactState state = ContactState::free;  // state before the step
  double nearest_distance_m = 0;
  Vec3 normal = Vec3::Zero();
  Vec3 step = Vec3::Zero();
};

// (4.2)
double psi(double r, const ProxyParameters& p);

// Both roots of (4.9), (4.10) for one point, from its foot on the ray. The function returns false if there is
// no real root.
bool roots(const Vec3& point, const Vec3& from, const Vec3& direction, double radius, double& near,
           double& far);

// (4.6), (4.7), (4.11), (4.12), with u = HIP - P.
Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p);

// (4.4), (4.9), (5.9)
template <class Point>
Vec3 free_step(const std::vector<Point>& points, const Vec3& proxy_W, const Vec3& u,
               const ProxyParameters& p) {
  const double distance = u.norm();
  if (distance == 0) return Vec3::Zero();
  const Vec3 direction = u / distance;
  double step = distance, near = 0, far = 0;
  for (const Point& point : points) {
    const Vec3& x = place_of(point);
    if ((x - proxy_W).dot(direction) <= 0) continue;
    const double radius = p.contact_radius_m() + region_radius_of(point);
    if (roots(x, proxy_W, direction, radius, near, far) && near > 0) step = std::min(step, near);
  }
  return step < distance ? Vec3(step * direction) : u;
}

// (4.5), (4.10), (5.11)
template <class Point>
Vec3 entrenched_step(const std::vector<Point>& points, const Vec3& proxy_W, const Vec3& normal,
                     const ProxyParameters& p) {
  double step = 0, near = 0, far = 0;
  for (const Point& point : points) {
    const Vec3& x = place_of(point);
    const double radius = region_radius_of(point);
    if ((x - proxy_W).norm() >= p.r1_m + radius) continue;
    if (roots(x, proxy_W, normal, p.contact_radius_m() + radius, near, far)) step = std::max(step, far);
  }
  return step * normal;
}

// Sets state and step from the nearest distance and the normal. u = HIP - P.
template <class Point>
void take_step(const std::vector<Point>& points, const Vec3& proxy_W, const Vec3& u, const ProxyParameters& p,
               Step& out) {
  if (out.nearest_distance_m < p.r1_m) {
    out.state = ContactState::entrenched;
    out.step = naive::entrenched_step(points, proxy_W, out.normal, p);
  } else if (out.nearest_distance_m <= p.r2_m) {
    out.state = ContactState::contact;
    out.step = naive::contact_step(out.normal, u, p);
  } else {
    out.step = naive::free_step(points, proxy_W, u, p);
  }
}

// One proxy step, 4.2.3 and 4.2.4, which checks every point. pre: step_rule = variable, free_root = ahead.
Step proxy_step(const std::vector<Vec3>& points, const Vec3& proxy_W, const Vec3& hip_W,
                const Vec3& previous_normal, const ProxyParameters& p);

std::vector<Vec3> points_of(const PointCloud& cloud);

// Returns the indices of all points with |x - centre| <= radius, plus the radius of the point's region if it
// has one, rising.
std::vector<std::uint32_t> points_within(const PointCloud& cloud, const Ball& ball);

// A wavy wall across the view of a 640x480 camera at the origin, at that mean distance along z.
PointCloud wave_image(double distance_m);

// Balls around centres on a surface, and the points within them.
struct Queries {
  std::string name;
  PointCloud cloud;
  std::vector<Ball> balls = {};
  std::vector<std::vector<std::uint32_t>> expected = {};  // points_within() of each ball, or of each n-th
};

// slide: successive centres are 0.1 mm apart, the way of a tick at 0.1 m/s. jump: the centres are random
// points, as if each query came from another user. Neither caches nor branch predictors help then.
enum class Centres { slide, jump };

// Balls of 1 cm. The cloud is a flat grid of 100x100 points.
Queries on_grid(Centres centres);
// The cloud is organised and in the camera frame. A slide follows one row, from the middle to the right.
Queries on_image(const std::string& name, PointCloud cloud, Centres centres);

}  // namespace remote_touch::naive
