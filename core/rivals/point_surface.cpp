#include "core/rivals/point_surface.h"

#include <cmath>

#include "core/rivals/exact_sum.h"
#include "core/rivals/point_normals.h"

namespace remote_touch {

namespace {

// A gradient shorter than this has no direction, because it is only rounding.
constexpr double kNoDirection = 1e-10;
// Smaller sums of weights are mostly rounding: the position counts as outside of all support.
constexpr double kMinWeight = 1e-6;
// If the middle variance is below this, in units of R^2, the points do not span a plane.
constexpr double kMinWidth = 1e-6;
// An upper bound of the length of a term of the gradient, with which the terms are scaled to magnitude 1.
constexpr double kMaxTerm = 4;

// weight: w at a distance; slope: the factor of (x - p) / R in the gradient of w with respect to p / R.
struct Bell {
  double weight, slope;
};

// The polynomial is factored, so that rounding near the rim makes no weight negative.
Bell wyvill(double squared) {
  const double rest = 1 - squared;
  return {rest * rest * (1 - squared * (4.0 / 9)), 2 * rest * (22.0 / 9 - squared * (12.0 / 9))};
}

Bell wendland(double squared) {
  const double q = std::sqrt(squared), rest = 1 - q, cubed = rest * rest * rest;
  return {cubed * rest * (4 * q + 1), 20 * cubed};
}

// Calls act(bell, e, i) for every point i within R, e = (x - p) / R.
template <class Act>
void for_each_near(const PointsView& points, const Vec3& p_W, double radius_m, SurfaceWeight weight,
                   const Act& act) {
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 e = (Vec3(points.x[i], points.y[i], points.z[i]) - p_W) / radius_m;
    const double squared = e.squaredNorm();
    if (!(squared < 1)) continue;
    act(weight == SurfaceWeight::wyvill ? wyvill(squared) : wendland(squared), e, i);
  }
}

}  // namespace

Vec3 SurfaceSample::normal() const {
  const double length = gradient.norm();
  return length > kNoDirection ? Vec3(gradient / length) : Vec3::Zero();
}

double SurfaceSample::distance() const {
  const double length = gradient.norm();
  return length > kNoDirection ? value / length : std::copysign(1.0, value);
}

SurfaceSample PointSurface::at(const PointsView& points, double sum_grid, const Vec3& p_W,
                               const Vec3& side) const {
  return kind_ == SurfaceKind::metaballs ? metaballs(points, sum_grid, p_W)
                                         : surfels(points, sum_grid, p_W, side);
}

SurfaceSample PointSurface::metaballs(const PointsView& points, double sum_grid, const Vec3& p_W) const {
  ExactSum weights(sum_grid);
  ExactVector slopes(sum_grid);
  for_each_near(points, p_W, radius_m_, weight_, [&](const Bell& bell, const Vec3& e, std::size_t) {
    weights.add(bell.weight);
    slopes.add((bell.slope / kMaxTerm) * e);
  });
  if (!(weights.value() > 0)) return {};
  return {true, threshold_ - weights.value(), -kMaxTerm * slopes.value()};
}

SurfaceSample PointSurface::surfels(const PointsView& points, double sum_grid, const Vec3& p_W,
                                    const Vec3& side) const {
  ExactMoments moments(sum_grid);
  for_each_near(points, p_W, radius_m_, weight_,
                [&](const Bell& bell, const Vec3& e, std::size_t) { moments.add(bell.weight, e); });
  if (!(moments.weight() > kMinWeight)) return {};
  const Vec3 mean = moments.mean();  // a - p
  const ThinnestAxis thin = thinnest_axis(moments.covariance());
  if (thin.middle < kMinWidth) {
    const double length = mean.norm();
    return {true, length, length > kNoDirection ? Vec3(-mean / length) : Vec3::Zero()};
  }
  const double ahead = side.isZero(0) ? -thin.axis.dot(mean) : thin.axis.dot(side);
  const Vec3 n = ahead < 0 ? Vec3(-thin.axis) : thin.axis;
  return {true, -n.dot(mean), n};
}

SurfaceSample PointSurface::oriented(const PointsView& points, const Vec3* normals, double sum_grid,
                                     const Vec3& p_W) const {
  ExactSum weights(sum_grid);
  ExactVector first(sum_grid), directions(sum_grid);
  for_each_near(points, p_W, radius_m_, weight_, [&](const Bell& bell, const Vec3& e, std::size_t i) {
    weights.add(bell.weight);
    first.add(bell.weight * e);
    directions.add(bell.weight * normals[i]);
  });
  if (!(weights.value() > kMinWeight)) return {};
  const Vec3 mean = first.value() / weights.value(), sum = directions.value();  // a - p
  const double length = sum.norm();
  if (!(length > kMinWeight)) return {};
  const Vec3 n = sum / length;
  return {true, -n.dot(mean), n};
}

}  // namespace remote_touch
