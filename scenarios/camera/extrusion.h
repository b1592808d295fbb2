// A convex profile in the (z, y) plane, extruded along x: boxes and ramps, with exact distance and ray cast.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

class Extrusion {
 public:
  // Corners (z, y) of a convex profile, counter-clockwise with z to the right and y up; metres.
  Extrusion(std::vector<std::array<double, 2>> profile, double x_low, double x_high);

  // Distance to the surface, negative inside; exact on both sides.
  double signed_distance(const Vec3& p) const;
  // Smallest t >= 0 at which origin + t direction enters the solid; infinite if it does not.
  double cast(const Vec3& origin, const Vec3& direction) const;
  // Height of the top over (x, z); minus infinity beside the solid.
  double height(double x, double z) const;

 private:
  std::vector<std::array<double, 2>> profile_;
  double x_low_, x_high_;
};

}  // namespace remote_touch
