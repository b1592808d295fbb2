#include "core/tool/contact/touched_points.h"

#include <algorithm>

#include "core/tool/contact/contact_thinning.h"
#include "core/tool/contact/disk_contact.h"

namespace remote_touch {

namespace {

constexpr double kClustersPer_m = 100;  // touching points within a centimetre are counted as one cluster

}  // namespace

void TouchedPoints::on_frame() {
  searched_m_ = -1;
}

void TouchedPoints::reserve(std::size_t padded_size) {
  groups_.grow(padded_size / kLanes + 1), nearest_.grow(padded_size / kLanes + 1);
  clusters_.grow(padded_size + kLanes), unclear_.grow(padded_size);
  searched_m_ = -1;
}

void TouchedPoints::search(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  searched_at_ = pose, searched_m_ = remote_touch::searched_m(reach_m, kSpare_m);
  is_new_ = true;
  const std::span<const std::uint32_t> found = finder.groups_within(finder.cloud(), pose, searched_m_);
  group_count_ = found.size();
  std::copy(found.begin(), found.end(), groups_.data());
}

// Groups without a point that a search for searched_m_ has to find.
void TouchedPoints::drop_far_groups() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < group_count_; ++i) {
    groups_[kept] = groups_[i], nearest_[kept] = nearest_[i];
    kept += nearest_[i] > searched_m_ ? 0 : 1;
  }
  group_count_ = kept;
}

Touched TouchedPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                             double reach_m, double voxels_m) {
  if (!(searched_m_ - max_change_m(finder, searched_at_, pose) > reach_m)) search(finder, pose, reach_m);
  const TouchLimits limits{reach_m, voxels_m, touch_m_, finder.max_slope(),
                           passed_m(reach_m, max_change_m(finder, searched_at_, pose))};
  TouchedSummary sum{};
  sum.cluster = clusters_.data(), sum.unclear = unclear_.data();
  kernels.tool.touched_points(finder.cloud().columns(), groups_.data(), group_count_, disk_radius_ratio_,
                              kClustersPer_m, posed_field(finder.tool(), pose), finder.voxels(), limits,
                              nearest_.data(), is_new_, sum);
  if (is_new_) drop_far_groups();
  is_new_ = false;
  Touched all;
  all.points = static_cast<int>(sum.points);
  all.nearest_distance_m = sum.nearest;
  if (all.points > 0) all.state = sum.is_inside ? ContactState::entrenched : ContactState::contact;
  cluster_count_ = sum.clusters, unclear_count_ = sum.unclear_count;
  add_unclear(finder, pose, limits, all);
  std::sort(clusters_.data(), clusters_.data() + cluster_count_);
  all.clusters =
      static_cast<int>(std::unique(clusters_.data(), clusters_.data() + cluster_count_) - clusters_.data());
  return all;
}

// Disks whose nearest place has to be searched, and places outside the grid.
void TouchedPoints::add_unclear(const TouchFinder& finder, const ToolPose& pose, const TouchLimits& limits,
                                Touched& all) {
  const VoxelTool& tool = finder.tool();
  const TiledCloud& cloud = finder.cloud();
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
        lower_bound_m(disk) <= limits.touch && nearest_place(tool, disk).at.distance_m <= limits.touch;
    if (voxel == Voxel::free && !is_touched) continue;
    all.state =
        std::max(all.state, voxel == Voxel::interior ? ContactState::entrenched : ContactState::contact);
    ++all.points;
    clusters_[cluster_count_++] = cell_number(p_T, kClustersPer_m);
  }
}

}  // namespace remote_touch
