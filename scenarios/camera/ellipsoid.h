// A solid ellipsoid with exact distance, ray cast and height.
#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

class Ellipsoid {
 public:
  // semi_axes_m, all > 0, lie along the columns of axes, which is a rotation.
  Ellipsoid(const Vec3& centre_m, const Vec3& semi_axes_m,
            const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

  // Distance to the surface, negative inside; exact on both sides.
  double signed_distance(const Vec3& p) const;
  // Returns the point of the surface that is closest to p, or one of them if there are several.
  Vec3 closest(const Vec3& p) const;
  // Smallest t >= 0 at which origin + t direction enters the solid; infinite if it does not.
  double cast(const Vec3& origin, const Vec3& direction) const;
  // Height (y) of the top over (x, z); minus infinity beside the solid.
  double height(double x, double z) const;
  // (q_1/e_1)^2 + (q_2/e_2)^2 + (q_3/e_3)^2 along its axes: below 1 inside, 1 on the surface.
  double level(const Vec3& p) const { return (to_unit_ball_ * (p - centre_)).squaredNorm(); }

 private:
  // The part of a ray's line inside the solid: t from middle - half to middle + half. half is NaN if the line
  // misses the solid.
  struct Chord {
    double middle, half;
  };
  Chord chord(const Vec3& origin, const Vec3& direction) const;

  Vec3 centre_, semi_axes_;
  Eigen::Matrix3d axes_, to_unit_ball_;
};

}  // namespace remote_touch
