// The place nearest to a goal that lies over a few planes: the minimisation of C. Zilles and K. Salisbury, "A
// constraint-based god-object method for haptic display", IROS 1995. They solve it by Lagrange multipliers
// for one, two or three active planes; here all such choices are tried, for at most three planes hold a point
// in space, and the nearest place that obeys every plane is the answer.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/vector.h"

namespace remote_touch {

class PlaneConstraints {
 public:
  // slack_m: planes may be violated by so much, for rounding.
  explicit PlaneConstraints(double slack_m) : slack_m_(slack_m) {}

  static constexpr std::size_t kMaxCount = 8;

  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  // n . y >= n . point + offset_m for a unit normal n. Returns false when there are kMaxCount already.
  bool add(const Vec3& normal, const Vec3& point, double offset_m);

  struct Nearest {
    bool found = false;  // some place obeys all planes
    Vec3 place = Vec3::Zero();
    int active_planes = 0;  // planes, 0 to 3
  };
  Nearest nearest(const Vec3& goal) const;

 private:
  struct Plane {
    Vec3 normal, point;
    double offset_m;
  };
  std::array<Plane, kMaxCount> planes_;
  std::size_t count_ = 0;
  double slack_m_;
};

}  // namespace remote_touch
