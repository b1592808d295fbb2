// Fit of the heights of a sheet to noisy points: local planes of least squares.
#pragma once

#include <array>
#include <vector>

#include "core/beyond/tracked_surface/height_map.h"
#include "core/beyond/tracked_surface/patch_points.h"

namespace remote_touch {

// The curvature of a whole patch. Planes in wide windows would flatten it.

// h = c0 + c1 u + c2 v + c3 u^2 + c4 u v + c5 v^2.
struct Trend {
  double c[6] = {};

  double height(double u, double v) const {
    return c[0] + u * (c[1] + c[3] * u + c[4] * v) + v * (c[2] + c[5] * v);
  }
  double slope_u(double u, double v) const { return c[1] + 2 * c[3] * u + c[4] * v; }
  double slope_v(double u, double v) const { return c[2] + c[4] * u + 2 * c[5] * v; }
};

// Fits the trend by least squares to the members within kTrendRadius of the origin. The trend is zero if they
// are too few or lie too much to one side. sigma: standard deviation of the noise; the part of the curvature
// that noise explains is removed. The sums are exact, so the order of the points has no effect.
inline constexpr double kTrendRadius = 6;  // contact radii
Trend fit_trend(const PatchPoints& points, double sigma);

// A plane through the points of a window.
struct PlaneFit {
  double height = 0, slope_u = 0, slope_v = 0;  // values at the queried position
  double variance = 0;                          // variance of the height divided by the variance of the noise
  double residual = 0;                          // sum of squared residuals
  double count = 0;                             // number of points
  bool valid = false;                           // false: too few points, or all nearly on a line
};

// Sums over the members of a patch. The sums over any window of whole cells follow from them in constant
// time.
class HeightFit {
 public:
  HeightFit() : sums_(static_cast<std::size_t>(kCorners) * kCorners) {}
  // Computes the sums over the members of points after the trend is subtracted; planes are fitted to the
  // rest. pre: the members lie on the map's square.
  void set_points(const PatchPoints& points, const Trend& trend = {});

  // Returns the plane through the points of a square window around (u, v). half_side, in contact radii, is
  // rounded to whole cells.
  PlaneFit plane_around(double u, double v, double half_side) const;
  // Returns the standard deviation of the heights about the planes of small blocks; NaN if no block has
  // enough points. It is a low quantile over the blocks, so that blocks with edges have no effect.
  double noise() const;
  // Sets each node of the map to the plane of the widest window that differs from the narrower ones by no
  // more than noise of standard deviation sigma explains (Lepski's rule, by intersecting confidence
  // intervals: Goldenshluger and Nemirovski 1997). Windows too narrow to determine a height are skipped.
  void fit(double sigma, HeightMap& map) const;
  // Returns the number of members per square of one contact radius: the median over the squares that have
  // any.
  double typical_density() const { return density_; }

 private:
  static constexpr int kCorners = HeightMap::kCells + 1;
  enum Moment { n, su, sv, sh, uu, uv, vv, uh, vh, hh, kMoments };
  using Sums = std::array<double, kMoments>;
  const Sums& below(int cu, int cv) const { return sums_[static_cast<std::size_t>(cv * kCorners + cu)]; }
  Sums window(int corner_u, int corner_v, int half) const;
  double count(int corner_u, int corner_v, int half) const;
  static PlaneFit plane(const Sums& sums, double u, double v);
  void choose(int i, int j, double sigma, HeightMap::Node& node) const;

  double median_density() const;

  Trend trend_;
  double density_ = 0;
  std::vector<Sums> sums_;  // sums at each corner of cells, over all points with smaller u and v
};

}  // namespace remote_touch
