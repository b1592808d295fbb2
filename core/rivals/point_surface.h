// A point cloud as an implicit surface: A. Leeper, S. Chan, K. Salisbury, "Point clouds can be represented as
// implicit surfaces for constraint-based haptic rendering", ICRA 2012, [84] of the dissertation. f is
// positive outside, and f = 0 is the surface. There are two kinds:
//
//   metaballs  f(p) = T - sum_i w(|p - x_i| / R): every point is expanded to a smooth ball
//   surfels    f(p) = n . (p - a) / R: a is the weighted mean of the points around p, n the axis along which
//              their weighted covariance is smallest (total least squares). The gradient is taken to be n.
//
// Lengths are in units of the support radius R, so f and its gradient are dimensionless. r_f of points is
// ignored. The bits are the same for every order of the points: the sums are pre-rounded as in
// core/kernels/kernels.h.
#pragma once

#include "core/geometry/vector.h"
#include "core/kernels/points_view.h"

namespace remote_touch {

enum class SurfaceKind { metaballs, surfels };
// The weight w(q): 1 at q = 0; from q = 1 on both w and its slope are zero.
enum class SurfaceWeight {
  wyvill,   // 1 - 4/9 q^6 + 17/9 q^4 - 22/9 q^2
  wendland  // (1 - q)^4 (4 q + 1), the psi of (4.2)
};

// f and its gradient at a position. f is positive outside of all support, and the gradient is zero there.
struct SurfaceSample {
  bool supported = false;  // true: there are points within R
  double value = 1;
  Vec3 gradient = Vec3::Zero();

  // Returns the unit normal out of the surface; zero if the gradient is too short to have a direction.
  Vec3 normal() const;
  // Returns the estimated distance to the surface, f / |grad f|, in units of R, negative inside. It is exact
  // for a plane of surfels, else it is one Newton step. It is 1 with the sign of f if there is no gradient.
  double distance() const;
};

class PointSurface {
 public:
  // threshold: T of the metaballs, above 0.
  PointSurface(SurfaceKind kind, SurfaceWeight weight, double support_radius_m, double threshold)
      : kind_(kind), weight_(weight), radius_m_(support_radius_m), threshold_(threshold) {}

  // points: all points within R of p, and any beyond. sum_grid: M of core/kernels/kernels.h for that number
  // of points. side: surfels have no inside of their own. n is chosen within 90 degrees of side, or, if side
  // is zero, towards the side on which p is. One point, or points on a line, have no plane: p is then
  // outside.
  SurfaceSample at(const PointsView& points, double sum_grid, const Vec3& p_W, const Vec3& side) const;

  // Evaluates surfels that have a side. n is the weighted mean of the unit normals of the points. normals:
  // one for each point of the list; zero if a point has none.
  SurfaceSample oriented(const PointsView& points, const Vec3* normals, double sum_grid,
                         const Vec3& p_W) const;

 private:
  SurfaceSample metaballs(const PointsView& points, double sum_grid, const Vec3& p_W) const;
  SurfaceSample surfels(const PointsView& points, double sum_grid, const Vec3& p_W, const Vec3& side) const;

  SurfaceKind kind_;
  SurfaceWeight weight_;
  double radius_m_, threshold_;
};

}  // namespace remote_touch
