// Fit of the heights of a sheet to noisy points: local planes of least squares.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/beyond/tracked_surface/height_map.h"
#include "core/points/neighbour_search.h"

namespace remote_touch {

// The points of a frame around a patch, in the patch's coordinates.

// The region in which the points of a patch replace those of the frame: a cylinder about the patch's normal;
// radius and half height in contact radii.
struct PatchRegion {
  PatchFrame frame;
  double radius = 0, half_height = 0;

  bool holds(const PatchPlace& p) const {
    return p.u * p.u + p.v * p.v < radius * radius && std::abs(p.h) <= half_height;
  }
  bool holds(const Ball& ball) const;
  // Returns the bounding ball, m, world frame.
  Ball around() const {
    return {frame.origin_W(), std::hypot(radius, half_height) * frame.unit_m() * (1 + 1e-9)};
  }
};

// Only reserve() allocates.
class PatchPoints {
 public:
  explicit PatchPoints(const Kernels& kernels) : kernels_(kernels) {}
  void reserve(std::size_t points);
  // Replaces the points with the gathered points of a region; none is a member of the sheet yet. pre:
  // reserve() was called for their frame.
  void set_points(const GatheredPoints& gathered, const PatchRegion& region);
  // clear() and add() are the alternative to set_points(): they add points one by one, as members or not.
  // These points have no source.
  void clear() { count_ = 0; }
  void add(const PatchPlace& place, bool is_member);
  // Computes the residual of each point: its height above the height that a map predicts; NaN if the map
  // predicts none.
  void set_residuals(const HeightMap& map);

  std::size_t size() const { return count_; }
  PatchPlace place(std::size_t i) const { return {u_[i], v_[i], h_[i]}; }
  // Returns the row of the point in the gathered points.
  std::uint32_t source(std::size_t i) const { return source_[i]; }
  bool is_member(std::size_t i) const { return member_[i] != 0; }
  void set_member(std::size_t i, bool member) { member_[i] = member; }
  double residual(std::size_t i) const { return residual_[i]; }

  // Returns the profile of the residuals of the points within reach of a position, measured along the patch.
  HeightProfile profile_near(const PatchPlace& place, double reach, double half_range) const;
  // Returns sums over the points whose residuals are near a plane.
  PlaneSums sums_near(const NearPlane& plane) const;
  // Returns sums over the members within radius of the origin, with their heights.
  QuadraticSums sums_of_quadratic(double radius) const;

 private:
  PatchColumns columns() const { return {u_.data(), v_.data(), h_.data(), source_.data()}; }

  const Kernels& kernels_;
  std::size_t count_ = 0;
  Buffer<double> u_, v_, h_, residual_;
  Buffer<std::uint32_t> source_;
  Buffer<std::uint8_t> member_;
  Buffer<std::int32_t> bin_;  // work buffer of profile_near()
};

// Points of a patch that do not belong to its sheet: points of other surfaces, or outliers. Distinguishes the
// two by density. A point belongs to a surface if the number of points per area around it, in layers at least
// as thick as the noise, is at least a quarter of the sheet's, and if there are at least two other points.
class StrayPoints {
 public:
  // Counts the points that are no members. per_unit_area: number of members in a square of one contact
  // radius.
  void count(const PatchPoints& points, const PatchRegion& region, double sigma, double per_unit_area);
  // Returns true if the point belongs to a surface. pre: the point is no member.
  bool is_surface(const PatchPlace& p) const;

 private:
  int column(double coordinate) const;
  int layer(double height) const;

  double half_side_ = 0, half_height_ = 0, thickness_ = 1, min_ = 0;
  int side_ = 0, layers_ = 0;
  std::vector<std::uint16_t> counts_ = std::vector<std::uint16_t>(kMaxCount);
  static constexpr std::size_t kMaxCount = 18 * 18 * 130;
};

// The curvature of a whole patch. Planes in wide windows would flatten it.
//   h = c0 + c1 u + c2 v + c3 u^2 + c4 u v + c5 v^2
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
