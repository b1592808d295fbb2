#include "core/dissertation/proxy/region_motion.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

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

namespace {

// A motion violates a normal if it goes against it by more than the rounding of unit vectors.
constexpr double kRounding = 1e-12;
// Every round ends farther from u than the one before, so the rounds end. The limit guards against rounding.
constexpr int kMaxRounds = 100;

// Orders normals by their coordinates, so that the choice among equal ones does not depend on the order of
// the points. Magnitudes are compared first, because left and right are alike.
bool comes_before(const Vec3& a, const Vec3& b) {
  const Vec3 size_a = a.cwiseAbs(), size_b = b.cwiseAbs();
  if (size_a != size_b)
    return std::lexicographical_compare(size_a.begin(), size_a.end(), size_b.begin(), size_b.end());
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// Normals of the regions that hold a motion back. One normal leaves a plane to move in, two leave a line, and
// three leave no motion.
struct Barriers {
  std::array<Vec3, 3> normal{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::size_t count = 0;

  void add(const Vec3& n) {
    assert(count < normal.size());
    normal[count++] = n;
  }
};

// Returns v without its component along `by`.
Vec3 less(const Vec3& v, const Vec3& by) {
  return v - (v.dot(by) / by.squaredNorm()) * by;
}

// Finds the normal, among those of the touching regions, that the motion s violates most. Returns false if s
// violates none by more than the slack. The regions are not stored, because a proxy may touch very many.
bool find_most_violated_normal(const PointsView& points, const Vec3& p_W, double r2, const Vec3& s,
                               double slack, Vec3& normal) {
  double min = -slack;
  bool found = false;
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 from = p_W - Vec3(points.x[i], points.y[i], points.z[i]);
    const double distance = from.norm(), reach = points.radius ? r2 + points.radius[i] : r2;
    if (!(distance <= reach) || distance == 0) continue;
    const Vec3 n = from / distance;
    const double along = n.dot(s);
    if (along < min || (found && along == min && comes_before(n, normal)))
      min = along, normal = n, found = true;
  }
  return found;
}

// Projects u onto the motions that up to three barriers allow. onto() keeps only the barriers that the result
// lies on.
class Projection {
 public:
  Projection(const Vec3& u, double slack) : u_(u), slack_(slack) {}

  Vec3 onto(Barriers& all) const {
    Best best;
    for (std::size_t i = 0; i < all.count; ++i) {
      on_plane(all, i, best);
      for (std::size_t j = i + 1; j < all.count; ++j) on_line(all, i, j, best);
    }
    all = best.barriers;
    return best.s;
  }

 private:
  struct Best {
    Vec3 s = Vec3::Zero();
    Barriers barriers{};
    double squared = std::numeric_limits<double>::infinity();
  };

  void on_plane(const Barriers& all, std::size_t i, Best& best) const {
    const Vec3& a = all.normal[i];
    Barriers one;
    one.add(a);
    offer(all, u_ - u_.dot(a) * a, one, best);
  }
  // The motion loses its components along both normals. The sum and the difference of the normals span the
  // same plane, and give the same bits whichever normal comes first. The shorter of the two has the less
  // accurate direction, so its component along the longer one is removed.
  void on_line(const Barriers& all, std::size_t i, std::size_t j, Best& best) const {
    const Vec3 &a = all.normal[i], &b = all.normal[j];
    Vec3 longer = a + b, shorter = a - b;
    if (longer.squaredNorm() < shorter.squaredNorm()) std::swap(longer, shorter);
    if (!(shorter.norm() > kRounding)) return;  // the normals are parallel: one plane
    shorter = less(shorter, longer);
    const double to_a = u_.dot(a), to_b = u_.dot(b), between = a.dot(b);
    const double push_a = between * to_b - to_a, push_b = between * to_a - to_b;
    if (std::min(push_a, push_b) < -slack_) return;  // a region holds back, it does not pull
    Barriers two;
    two.add(a), two.add(b);
    offer(all, less(less(u_, longer), shorter), two, best);
  }
  void offer(const Barriers& all, const Vec3& s, const Barriers& barriers, Best& best) const {
    for (std::size_t i = 0; i < all.count; ++i)
      if (all.normal[i].dot(s) < -slack_) return;
    const double squared = (u_ - s).squaredNorm();
    if (squared < best.squared) best = {s, barriers, squared};
  }

  const Vec3& u_;
  double slack_;
};

}  // namespace

bool is_in_crease(const PointsView& points, const Vec3& p_W, const Vec3& normal_W, double r2, double cosine) {
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 from = p_W - Vec3(points.x[i], points.y[i], points.z[i]);
    const double distance = from.norm(), reach = points.radius ? r2 + points.radius[i] : r2;
    if (distance <= reach && from.dot(normal_W) < cosine * distance) return true;
  }
  return false;
}

// Uses the dual method: the most violated region is added to the barriers until no region is violated.
std::optional<Vec3> admissible_motion(const PointsView& points, const Vec3& p_W, const Vec3& u, double r2) {
  const double slack = kRounding * u.norm();
  const Projection projection(u, slack);
  Barriers barriers;
  Vec3 s = u, normal = Vec3::Zero();
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!find_most_violated_normal(points, p_W, r2, s, slack, normal)) return s;
    barriers.add(normal);
    s = projection.onto(barriers);
    if (s.isZero(0)) return s;  // held from all sides
  }
  return std::nullopt;
}

}  // namespace remote_touch
