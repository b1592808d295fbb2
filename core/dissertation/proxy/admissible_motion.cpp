#include "core/dissertation/proxy/admissible_motion.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace remote_touch {

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

  // pre: fewer than three.
  void add(const Vec3& n) { normal[count++] = n; }
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
