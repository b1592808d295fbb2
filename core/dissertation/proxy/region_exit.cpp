#include "core/dissertation/proxy/region_exit.h"

#include <array>
#include <limits>

#include "core/dissertation/proxy/proxy_step.h"
#include "core/kernels/lanes.h"

namespace remote_touch {

namespace {

Vec3 unit_or(const Vec3& v, const Vec3& other) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : other;
}

std::array<Vec3, 9> directions(const Vec3& normal_W, const Vec3& u) {
  const Vec3 n = unit_or(normal_W, unit_or(-u, Vec3::UnitY()));
  int min = 0;
  n.cwiseAbs().minCoeff(&min);
  // The component of u across the normal. It is only rounding if u runs along the normal.
  const Vec3 across = u - u.dot(n) * n;
  const bool has_direction = across.squaredNorm() > 1e-24 * u.squaredNorm();
  const Vec3 a = unit_or(has_direction ? across : n.cross(Vec3::Unit(min)), Vec3::Zero()), b = n.cross(a);
  constexpr double kHalfWay = 0.70710678118654752;
  return {n, kHalfWay * (n + a), kHalfWay * (n - a), kHalfWay * (n + b), kHalfWay * (n - b), a, -a, b, -b};
}

// Returns the distance along a line to the first position outside all regions. Returns infinity if that
// distance is max_m or more, or if the line is not outside after kMaxExits regions.
double exit_along(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W, const Vec3& direction,
                  double max_m, const ProxyParameters& p) {
  const auto outside = [&](const PointsView& points, const Vec3& q_W) {
    const ProxyRegions regions{p.r1_m, p.r2_m, p.r3_m, near.sum_grid(), p.stiffness_N_per_m};
    const double nearest_m = kernels.proxy.contact_query(points, q_W.data(), regions).nearest;
    return classify(nearest_m, p) != ContactState::entrenched;
  };
  double done_m = 0;
  for (int exits = 0; done_m < max_m; ++exits) {
    const Vec3 q_W = p_W + done_m * direction;
    const PointsView points = near.around(q_W).view();
    if (outside(points, q_W)) return done_m;
    if (exits == kMaxExits) break;
    done_m += kernels.proxy.exit_distance(points, q_W.data(), direction.data(), p.contact_radius_m(), p.r1_m);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<Vec3> straight_exit(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W,
                                  const Vec3& normal_W, const Vec3& u, const ProxyParameters& p) {
  double shortest_m = std::numeric_limits<double>::infinity();
  Vec3 exit_W = p_W;
  for (const Vec3& direction : directions(normal_W, u)) {
    const double length_m = exit_along(near, kernels, p_W, direction, shortest_m, p);
    if (length_m < shortest_m) shortest_m = length_m, exit_W = p_W + length_m * direction;
  }
  return shortest_m < std::numeric_limits<double>::infinity() ? std::optional(exit_W) : std::nullopt;
}

std::optional<double> nearest_region_radius_m(const PointsView& points, const Vec3& p_W) {
  double nearest_m = std::numeric_limits<double>::infinity();
  std::optional<double> radius_m;
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    if (points.x[i] == kFarAway) continue;
    const double own_m = points.radius ? points.radius[i] : 0;
    const double distance_m = (p_W - Vec3(points.x[i], points.y[i], points.z[i])).norm() - own_m;
    if (distance_m < nearest_m || (distance_m == nearest_m && own_m < *radius_m))
      nearest_m = distance_m, radius_m = own_m;
  }
  return radius_m;
}

}  // namespace remote_touch
