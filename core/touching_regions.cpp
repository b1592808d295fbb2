#include "core/touching_regions.h"

namespace remote_touch {

namespace {

// A motion is in the way of a normal when it goes against it by more than the rounding of unit vectors.
constexpr double kRounding = 1e-12;

// The normals of the touching regions, one after the other; nothing is stored, for a proxy may touch very
// many.
class Normals {
 public:
  Normals(const PointsView& points, const Vec3& p_W, double r2) : points_(points), p_W_(p_W), r2_(r2) {}

  // The first position from i on that touches, or end.
  std::size_t next(std::size_t i, std::size_t end, Vec3& normal) const {
    for (; i < end; ++i) {
      const Vec3 from = p_W_ - Vec3(points_.x[i], points_.y[i], points_.z[i]);
      const double distance = from.norm(), reach = points_.radius ? r2_ + points_.radius[i] : r2_;
      if (!(distance <= reach) || distance == 0) continue;
      normal = from / distance;
      return i;
    }
    return end;
  }
  std::size_t end() const { return points_.padded_count; }

 private:
  const PointsView& points_;
  const Vec3& p_W_;
  double r2_;
};

// Each constraint in turn: where it is violated, the solution lies on its boundary, a problem of one
// dimension less with the constraints before it.
class Projection {
 public:
  Projection(const Normals& normals, const Vec3& u)
      : normals_(normals), u_(u), slack_(kRounding * u.norm()) {}

  Vec3 in_space() const {
    Vec3 s = u_, n;
    for (std::size_t i = normals_.next(0, normals_.end(), n); i < normals_.end();
         i = normals_.next(i + 1, normals_.end(), n))
      if (n.dot(s) < -slack_) s = on_plane(n, i);
    return s;
  }

 private:
  Vec3 on_plane(const Vec3& a, std::size_t before) const {
    Vec3 s = u_ - u_.dot(a) * a, n;
    for (std::size_t i = normals_.next(0, before, n); i < before; i = normals_.next(i + 1, before, n))
      if (n.dot(s) < -slack_) s = on_line(a.cross(n), i);
    return s;
  }
  Vec3 on_line(const Vec3& along, std::size_t before) const {
    const double squared = along.squaredNorm();
    if (!(squared > 0)) return Vec3::Zero();
    const Vec3 s = along * (along.dot(u_) / squared);
    Vec3 n;
    for (std::size_t i = normals_.next(0, before, n); i < before; i = normals_.next(i + 1, before, n))
      if (n.dot(s) < -slack_) return Vec3::Zero();
    return s;
  }

  const Normals& normals_;
  const Vec3& u_;
  double slack_;
};

}  // namespace

Vec3 admissible_motion(const PointsView& points, const Vec3& p_W, const Vec3& u, double r2) {
  const Normals normals(points, p_W, r2);
  return Projection(normals, u).in_space();
}

}  // namespace remote_touch
