// The points of a frame around a patch, in the patch's coordinates.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/beyond/tracked_surface/height_map.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

// The region in which the points of a patch replace those of the frame.

// A cylinder about the patch's normal; radius and half height in contact radii.
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

// Points of a patch that do not belong to its sheet: points of other surfaces, or outliers.

// Distinguishes the two by density. A point belongs to a surface if the number of points per area around it,
// in layers at least as thick as the noise, is at least a quarter of the sheet's, and if there are at least
// two other points.
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

}  // namespace remote_touch
