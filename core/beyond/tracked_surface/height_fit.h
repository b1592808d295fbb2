// The heights of a sheet over a patch, and their fit to noisy points: local planes of least squares.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/kernels/point_kernels.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"

namespace remote_touch {

// Coordinates of a patch of surface: two along it and the height above it, in units of the contact radius.

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

// Shrinkage: the part of a measurement that is kept if noise may explain it.

// Returns the standard error of the difference of two heights that each have this standard error, rounded up
// and at least 0.003; contact radii.
inline double error_of_two(double error) {
  return std::max(1.5 * error, 0.003);
}

// Returns the part of a measurement that its standard error does not explain: nearly all of a large
// measurement, nearly nothing of a small one.
inline double shrunk(double x, double error) {
  const double square = x * x;
  return square > 0 ? square / (square + 4 * error * error) * x : 0;
}

// Histogram of the heights of a patch's points. Counts in bins of a tenth of a contact radius, symmetric
// about height 0.
class HeightProfile {
 public:
  static constexpr double kBin = 0.1;
  static constexpr double kMaxRange = 51.2;

  explicit HeightProfile(double half_range = 0) { clear(half_range); }
  void clear(double half_range);
  void add(double height) {
    const double bin = (height + half_range_) / kBin;
    if (bin >= 0 && bin < bins_) count_[static_cast<std::size_t>(bin)] += 1;  // false for NaN
  }

  // Adds points, given by the indices of their bins. The index bins() means that a point is in no bin.
  void add_bins(const std::int32_t* bin, std::size_t number);

  int bins() const { return bins_; }
  double half_range() const { return half_range_; }
  double centre(int bin) const { return (bin + 0.5) * kBin - half_range_; }
  double count(int bin) const { return count_[static_cast<std::size_t>(bin)]; }
  double max() const;

  // Returns the profile smoothed with a triangle of about this standard deviation.
  HeightProfile smoothed(double sigma) const;
  // Returns the distance, at most reach in either direction, by which the other profile must be moved down to
  // agree best with this one, that is with the largest sum of products. If several distances are nearly as
  // good, it is the smallest of them.
  double shift_of(const HeightProfile& other, double reach) const;
  // Returns the distance from a height, upwards (1) or downwards (-1), to the border of another sheet: the
  // bottom of a valley that chance does not explain. Returns 2 half_range() if there is none. pre: the
  // profile is smoothed.
  double valley_from(double height, int direction) const;

 private:
  double half_range_ = 0;
  double window_ = 1;  // number of bins over which a count is averaged
  int bins_ = 0;
  static constexpr int kMaxBins = 1024;
  std::array<double, kMaxBins + 1> count_;  // count of each bin; then the count of points in no bin
};

// Heights over the square |u|, |v| <= kHalf around the patch's origin, in contact radii. Nodes, one contact
// radius apart, hold local planes. The corners of the cells between them hold heights. The map is bilinear in
// each cell, so it is continuous.
class HeightMap {
 public:
  static constexpr double kHalf = 8;
  static constexpr int kCells = 32;  // along each side
  static constexpr double kCell = 2 * kHalf / kCells;
  static constexpr int kNodes = kCells / 2 + 1;
  static constexpr double kNodePitch = 2 * kCell;

  struct Node {
    double height = 0, slope_u = 0, slope_v = 0;
    double error = 0;      // standard error of the height, if it has a plane
    bool known = false;    // true: the node has a plane
    bool covered = false;  // true: the sheet reaches this node; false: the plane only extends it
  };
  static double node_at(int i) { return i * kNodePitch - kHalf; }
  Node& node(int i, int j) { return nodes_[static_cast<std::size_t>(j * kNodes + i)]; }
  const Node& node(int i, int j) const { return nodes_[static_cast<std::size_t>(j * kNodes + i)]; }
  const Node& nearest_node(double u, double v) const;
  // Returns the standard error of the height at a position: that of the nearest node. If it has no plane, the
  // largest error of the nodes next to it that have one; infinite if there is none.
  double error(double u, double v) const;
  // Computes the heights of the corners. Must be called after nodes were changed.
  void fill_cells();

  // Sets the map to a plane that is known within `radius` contact radii of the origin.
  void set_plane(double height, double slope_u, double slope_v, double radius);
  // Extends the map by `rings` contact radii beyond its border, with planes.
  void extend(int rings);
  // Reduces the change since an earlier map of the same patch to the part that the errors of the nodes do not
  // explain. Then noise moves the map much less from frame to frame, and a motion well above the noise is
  // hardly delayed.
  void shrink_change_since(const HeightMap& earlier);
  // Adds a plane: the motion and rotation of the sheet.
  void add_plane(double height, double slope_u, double slope_v);

  // Returns the height at a position; NaN if no height is known there. A position beyond the map's border has
  // the height of the nearest position on the border.
  double height(double u, double v) const;
  // Returns the same heights for the kernels.
  HeightGrid grid() const { return {corner_.data(), kCells, kHalf, 1 / kCell, kLast}; }
  // The slopes at a position, from the heights half a cell away on either side; NaN if one of these is not
  // known.
  struct Slopes {
    double u, v;
  };
  Slopes slopes(double u, double v) const;
  // Returns the mean slopes of the nodes within `radius` that the sheet covers; slopes() if there are none.
  Slopes mean_slopes(double u, double v, double radius) const;
  bool covers(double u, double v) const;

 private:
  static constexpr int kCorners = kCells + 1;
  static constexpr double kLast = kCells - 1e-9;
  std::array<Node, kNodes * kNodes> nodes_;
  std::array<double, kCorners * kCorners> corner_;
};

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
