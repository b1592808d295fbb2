#include "core/dissertation/tool/contact/near_disks.h"

#include <algorithm>
#include <cmath>

#include "core/dissertation/tool/contact/contact_thinning.h"
#include "core/dissertation/tool/contact/posed_field.h"

namespace remote_touch {

void NearDisks::on_frame(const TiledCloud& cloud) {
  cloud_ = &cloud;
  reserve(cloud.padded_size());
}

void NearDisks::reserve(std::size_t padded_size) {
  points_.grow(padded_size), disks_.grow(padded_size + kLanes);
  nearest_.grow(padded_size / kLanes + 1), contacts_.grow(padded_size);
  count_ = 0, is_known_ = false, searched_m_ = -1;
}

void NearDisks::search(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  searched_at_ = pose, searched_m_ = remote_touch::searched_m(reach_m, kSpare_m);
  is_new_ = true;
  const std::span<const std::uint32_t> found = finder.within(*cloud_, pose, searched_m_);
  const PointColumns all = cloud_->columns();
  const double* const from[kPointColumns] = {all.x,  all.y,  all.z,       all.nx,
                                             all.ny, all.nz, all.spacing, all.extent};
  point_count_ = found.size();
  for (std::size_t column = 0; column < kPointColumns; ++column) {
    double* to = points_[column];
    for (std::size_t k = 0; k < point_count_; ++k) to[k] = from[column][found[k]];
    for (std::size_t k = point_count_; k % kLanes != 0; ++k) to[k] = kFarAway;
  }
}

void NearDisks::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose, double reach_m,
                      double max_lower_m) {
  if (!cloud_ || (is_known_ && pose == pose_ && reach_m == reach_m_ && max_lower_m == max_lower_m_)) return;
  const VoxelTool& tool = finder.tool();
  field_ = posed_field(tool, pose);
  // A point that was not found by the search had a field value above searched_m_, so it cannot be within
  // reach_m now.
  if (!(searched_m_ - max_change_m(finder, searched_at_, pose) > reach_m)) search(finder, pose, reach_m);
  const PointColumns points{points_[kX],  points_[kY],  points_[kZ],       points_[kNx],
                            points_[kNy], points_[kNz], points_[kSpacing], points_[kPointExtent]};
  const DiskLimits limits{reach_m, max_lower_m, kSearch_m,
                          passed_m(reach_m, max_change_m(finder, searched_at_, pose))};
  std::size_t outside_count = 0;
  count_ = kernels.tool.disks_in_field(points, point_count_, disk_radius_ratio_, cells_per_m_, field_, limits,
                                       nearest_.data(), is_new_, columns(), outside_count);
  if (outside_count > 0) finish_outside(tool, limits);
  is_new_ = false, is_known_ = true, pose_ = pose, reach_m_ = reach_m, max_lower_m_ = max_lower_m;
}

DiskColumns NearDisks::columns() const {
  return {{disks_[kPlace], disks_[kPlace + 1], disks_[kPlace + 2]},
          {disks_[kNormal], disks_[kNormal + 1], disks_[kNormal + 2]},
          disks_[kRadius],
          disks_[kDistance],
          {disks_[kGradient], disks_[kGradient + 1], disks_[kGradient + 2]},
          disks_[kSlope],
          disks_[kLower],
          disks_[kBound],
          disks_[kCell],
          disks_[kExtent]};
}

void NearDisks::append_contacts(std::span<const std::uint32_t> numbers, const TouchFinder& finder,
                                const Kernels& kernels, double side, std::vector<ToolContact>& contacts) {
  kernels.tool.disk_contacts(columns(), numbers.data(), numbers.size(), field_, kSearch_m, side,
                             contacts_.data());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const ContactNumbers& made = contacts_[k];
    if (std::isnan(made.depth)) {  // the search has left the grid
      const SurfaceDisk outside = disk(numbers[k]);
      contacts.push_back(
          near_contact(finder.tool(), outside, nearest_position(finder.tool(), outside), side));
    } else {
      contacts.push_back({Vec3(made.r_T), Vec3(made.n_T), made.depth, made.side});
    }
  }
}

void NearDisks::copy(std::size_t from, std::size_t to) {
  for (std::size_t column = 0; column < kDiskColumns; ++column) disks_[column][to] = disks_[column][from];
}

// Completes the disks for which the kernel wrote NaN, because their centres lie less than a cell outside the
// grid. Drops those of them that are beyond the limits.
void NearDisks::finish_outside(const VoxelTool& tool, const DiskLimits& limits) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::isnan(lower_m(i))) {
      SurfaceDisk outside = disk(i);
      outside.at = sample_field(tool, outside.p_T);
      const double lower = lower_bound_m(outside);
      if (!(outside.at.distance_m <= limits.reach && lower <= limits.lower)) continue;
      disks_[kDistance][i] = outside.at.distance_m;
      for (int axis = 0; axis < 3; ++axis)
        disks_[kGradient + static_cast<std::size_t>(axis)][i] = outside.at.gradient_T[axis];
      disks_[kSlope][i] = std::nan("");
      disks_[kLower][i] = disks_[kBound][i] = lower;
      disks_[kCell][i] =
          std::bit_cast<double>(cell_and_octant(outside.p_T, -outside.at.gradient_T, cells_per_m_));
    }
    if (kept != i) copy(i, kept);
    ++kept;
  }
  count_ = kept;
}

}  // namespace remote_touch
