#include "core/beyond/tracked_surface/patch_points.h"

#include <algorithm>

namespace remote_touch {

void PatchPoints::reserve(std::size_t points) {
  const std::size_t capacity = points + kLanes;  // the kernels also process the padding of the points
  for (Buffer<double>* column : {&u_, &v_, &h_, &residual_}) column->grow(capacity);
  source_.grow(capacity), member_.grow(capacity), bin_.grow(capacity);
}

void PatchPoints::set_points(const GatheredPoints& gathered, const PatchRegion& region) {
  PatchAxes axes{};
  const PatchFrame& frame = region.frame;
  for (int k = 0; k < 3; ++k) {
    axes.origin[k] = frame.origin_W()[k];
    axes.u[k] = frame.u_W()[k], axes.v[k] = frame.v_W()[k], axes.n[k] = frame.normal_W()[k];
  }
  axes.unit_m = frame.unit_m(), axes.radius = region.radius, axes.half_height = region.half_height;
  count_ = kernels_.patch.points_of_patch(gathered.view(), axes, columns());
  std::fill_n(member_.data(), count_, std::uint8_t{0});
}

void PatchPoints::add(const PatchPlace& place, bool is_member) {
  u_[count_] = place.u, v_[count_] = place.v, h_[count_] = place.h;
  member_[count_++] = is_member;
}

void PatchPoints::set_residuals(const HeightMap& map) {
  kernels_.patch.heights_above(columns(), count_, map.grid(), residual_.data());
}

HeightProfile PatchPoints::profile_near(const PatchPlace& place, double reach, double half_range) const {
  HeightProfile profile(half_range);
  const HeightBins bins{profile.half_range(), HeightProfile::kBin, profile.bins()};
  kernels_.patch.height_bins(columns(), count_, residual_.data(), place.u, place.v, reach, bins, bin_.data());
  profile.add_bins(bin_.data(), count_);
  return profile;
}

PlaneSums PatchPoints::sums_near(const NearPlane& plane) const {
  return kernels_.patch.sums_near_plane(columns(), count_, residual_.data(), plane);
}

QuadraticSums PatchPoints::sums_of_quadratic(double radius) const {
  return kernels_.patch.sums_of_quadratic(columns(), member_.data(), count_, radius);
}

}  // namespace remote_touch
