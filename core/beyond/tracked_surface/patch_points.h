// The points of a frame around a patch, in the patch's coordinates.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/beyond/tracked_surface/height_map.h"
#include "core/beyond/tracked_surface/height_profile.h"
#include "core/beyond/tracked_surface/patch_region.h"
#include "core/search/gathered_points.h"

namespace remote_touch {

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

}  // namespace remote_touch
