// The position nearest to a goal on the free side of a few planes: the minimisation of C. Zilles and K.
// Salisbury, "A constraint-based god-object method for haptic display", IROS 1995. They solve it by Lagrange
// multipliers for one, two or three active planes. Here all choices of up to three planes are tried, because
// no more than three are needed to hold a point in space. The result is the nearest position that obeys every
// plane.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/vector.h"

namespace remote_touch {

class PlaneConstraints {
 public:
  // slack_m: allowed violation of a plane, for rounding.
  explicit PlaneConstraints(double slack_m) : slack_m_(slack_m) {}

  static constexpr std::size_t kMaxCount = 8;

  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  // Adds the constraint n . y >= n . point + offset_m for a unit normal n. Returns false if there are
  // kMaxCount planes already.
  bool add(const Vec3& normal, const Vec3& point, double offset_m);

  struct Nearest {
    bool found = false;  // true: a position obeys all planes
    Vec3 position = Vec3::Zero();
    int active_planes = 0;  // number of planes that hold it, 0 to 3
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
