// Coordinates of a patch of surface: two along it and the height above it, in units of the contact radius.
#pragma once

#include <cmath>

#include "core/geometry/vector.h"
#include "core/kernels/patch_kernels.h"

namespace remote_touch {

// A position in a patch: u and v along it, h along its normal, in contact radii.
struct PatchPlace {
  double u, v, h;
};

// Coordinates are rounded to multiples of 2^-12 contact radii. So sums of the coordinates, of their squares
// and of their products are exact for any number of points that a patch can hold, and no result depends on
// the order of the points.
class PatchFrame {
 public:
  PatchFrame() = default;
  // The normal is a unit vector. The other two axes are computed from it alone.
  PatchFrame(const Vec3& origin_W, const Vec3& normal_W, double contact_radius_m);

  PatchPlace place(const Vec3& p_W) const {
    const Vec3 d = (p_W - origin_W_) / unit_m_;
    return {rounded(d.dot(u_W_)), rounded(d.dot(v_W_)), rounded(d.dot(n_W_))};
  }
  Vec3 world(const PatchPlace& p) const {
    return origin_W_ + unit_m_ * (p.u * u_W_ + p.v * v_W_ + p.h * n_W_);
  }
  const Vec3& origin_W() const { return origin_W_; }
  const Vec3& normal_W() const { return n_W_; }
  // Returns the unit normal of a surface that rises with these slopes along u and v.
  Vec3 normal_W(double slope_u, double slope_v) const {
    return (n_W_ - slope_u * u_W_ - slope_v * v_W_).normalized();
  }
  const Vec3& u_W() const { return u_W_; }
  const Vec3& v_W() const { return v_W_; }
  double unit_m() const { return unit_m_; }
  void move_along_normal(double units) { origin_W_ += units * unit_m_ * n_W_; }

  // Rounds x to a multiple of 2^-12, halves to even; pre: x is below 2^39.
  static double rounded(double x) { return (x + kRoundsToPatchGrid) - kRoundsToPatchGrid; }

 private:
  Vec3 origin_W_ = Vec3::Zero(), n_W_ = Vec3::UnitY(), u_W_ = Vec3::UnitZ(), v_W_ = Vec3::UnitX();
  double unit_m_ = 1;
};

}  // namespace remote_touch
