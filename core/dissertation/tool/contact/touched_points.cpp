#include "core/dissertation/tool/contact/touched_points.h"

#include <algorithm>

#include "core/dissertation/tool/contact/contact_thinning.h"
#include "core/dissertation/tool/contact/disk_contact.h"

namespace remote_touch {

namespace {

constexpr double kClustersPer_m = 100;  // touching points within a centimetre are counted as one cluster

}  // namespace

void TouchedPoints::reserve(std::size_t padded_size) {
  groups_.reserve(padded_size);
  clusters_.grow(padded_size + kLanes), unclear_.grow(padded_size);
}

Touched TouchedPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                             double reach_m, double voxels_m) {
  const GroupsInReach groups = groups_.within(finder, pose, reach_m);
  const TouchLimits limits{reach_m, voxels_m, touch_m_, finder.max_slope(), groups.passed_m};
  TouchedSummary sum{};
  sum.cluster = clusters_.data(), sum.unclear = unclear_.data();
  kernels.tool.touched_points(finder.cloud().packed().columns(), groups.group, groups.count,
                              disk_radius_ratio_, kClustersPer_m, posed_field(finder.tool(), pose),
                              finder.voxels(), limits, groups.nearest_m, groups.is_new, sum);
  groups_.on_measured();
  Touched all;
  all.points = static_cast<int>(sum.point_count);
  all.nearest_distance_m = sum.nearest;
  if (all.points > 0) all.state = sum.is_inside ? ContactState::entrenched : ContactState::contact;
  cluster_count_ = sum.clusters, unclear_count_ = sum.unclear_count;
  add_unclear(finder, pose, limits, all);
  std::sort(clusters_.data(), clusters_.data() + cluster_count_);
  all.clusters =
      static_cast<int>(std::unique(clusters_.data(), clusters_.data() + cluster_count_) - clusters_.data());
  return all;
}

// Adds the points that the kernel could not classify: those whose disks have to be searched, and those
// outside the grid.
void TouchedPoints::add_unclear(const TouchFinder& finder, const ToolPose& pose, const TouchLimits& limits,
                                Touched& all) {
  const VoxelTool& tool = finder.tool();
  const TiledCloud& cloud = finder.cloud().packed();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  for (std::size_t k = 0; k < unclear_count_; ++k) {
    const std::uint32_t i = unclear_[k];
    const Vec3 p_T = R_TW * (cloud.point(i) - pose.p_W);
    const SurfaceDisk disk{p_T, R_TW * cloud.normal(i), disk_radius_ratio_ * cloud.spacing_m(i),
                           sample_field(tool, p_T)};
    const double distance_m = disk.at.distance_m;
    if (distance_m > limits.reach) continue;
    all.nearest_distance_m = std::min(all.nearest_distance_m, distance_m);
    const Voxel voxel = distance_m <= limits.voxels ? finder.voxel(p_T) : Voxel::free;
    const bool is_touched =
        lower_bound_m(disk) <= limits.touch && nearest_position(tool, disk).at.distance_m <= limits.touch;
    if (voxel == Voxel::free && !is_touched) continue;
    all.state =
        std::max(all.state, voxel == Voxel::interior ? ContactState::entrenched : ContactState::contact);
    ++all.points;
    clusters_[cluster_count_++] = cell_number(p_T, kClustersPer_m);
  }
}

}  // namespace remote_touch
