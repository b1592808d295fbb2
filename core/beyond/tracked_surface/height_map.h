// The heights of a sheet over a patch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/kernels/point_kernels.h"
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

}  // namespace remote_touch
