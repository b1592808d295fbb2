#include "core/dissertation/tool/contact/touched_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/dissertation/tool/contact/contact_thinning.h"
#include "core/dissertation/tool/contact/disk_contact.h"

namespace remote_touch {

namespace {

constexpr double kClustersPer_m = 100;  // touching points within a centimetre are counted as one cluster

// Drops most repeated numbers, which would only make the sorting longer. Returns how many are left.
std::size_t drop_repeated(std::uint64_t* numbers, std::size_t count) {
  std::uint64_t seen[64];
  std::fill(std::begin(seen), std::end(seen), ~std::uint64_t{0});  // no cell has this number
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t& last = seen[(numbers[i] * 0x9e3779b97f4a7c15u) >> 58];
    if (last == numbers[i]) continue;
    last = numbers[kept++] = numbers[i];
  }
  return kept;
}

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
  add_unclear(finder, kernels, pose, limits, all);
  cluster_count_ = drop_repeated(clusters_.data(), cluster_count_);
  std::sort(clusters_.data(), clusters_.data() + cluster_count_);
  all.clusters =
      static_cast<int>(std::unique(clusters_.data(), clusters_.data() + cluster_count_) - clusters_.data());
  return all;
}

// Adds the points that the kernel could not classify: those whose disks have to be searched, and those
// outside the grid.
void TouchedPoints::add_unclear(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                                const TouchLimits& limits, Touched& all) {
  for (std::size_t first = 0; first < unclear_count_; first += kPortion) {
    const std::span numbers(unclear_.data() + first, std::min(kPortion, unclear_count_ - first));
    search_disks(finder, kernels, pose, numbers);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const double nearest_m = -contacts_[k].depth;
      if (std::isnan(nearest_m))
        add_single(numbers[k], finder, pose, limits, all);
      else if (nearest_m <= limits.touch)
        add_touched(disk_p_T(k), ContactState::contact, all);
    }
  }
}

// Searches the nearest positions on the disks of these points.
void TouchedPoints::search_disks(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                                 std::span<const std::uint32_t> numbers) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const PointColumns all = finder.cloud().packed().columns();
  const double* const from[] = {all.x, all.y, all.z, all.nx, all.ny, all.nz, all.spacing, all.extent};
  for (std::size_t column = 0; column < 8; ++column) {
    for (std::size_t k = 0; k < numbers.size(); ++k) points_[column][k] = from[column][numbers[k]];
    for (std::size_t k = numbers.size(); k % kLanes != 0; ++k) points_[column][k] = kFarAway;
  }
  const auto& p = points_;
  const auto& d = disks_;
  const DiskColumns disks{{d[0], d[1], d[2]},
                          {d[3], d[4], d[5]},
                          d[6],
                          d[7],
                          {d[8], d[9], d[10]},
                          d[11],
                          d[12],
                          d[13],
                          d[14],
                          d[15]};
  const PosedField field = posed_field(finder.tool(), pose);
  double nearest_m[kPortion / kLanes];
  std::uint32_t order[kPortion];
  std::iota(order, order + kPortion, 0u);
  std::size_t outside_count = 0;
  kernels.tool.disks_in_field(
      {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]}, numbers.size(), disk_radius_ratio_, kClustersPer_m,
      field, {kInfinite, kInfinite, kInfinite, kInfinite}, nearest_m, true, disks, outside_count);
  kernels.tool.disk_contacts(disks, order, numbers.size(), field, kInfinite, 0, contacts_.data());
  for (std::size_t k = 0; outside_count > 0 && k < numbers.size(); ++k)
    if (std::isnan(disks.lower[k])) contacts_[k].depth = disks.lower[k];
}

// Adds a point if it is touched. Does the same as the kernels.
void TouchedPoints::add_single(std::uint32_t number, const TouchFinder& finder, const ToolPose& pose,
                               const TouchLimits& limits, Touched& all) {
  const VoxelTool& tool = finder.tool();
  const TiledCloud& cloud = finder.cloud().packed();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  const Vec3 p_T = R_TW * (cloud.point(number) - pose.p_W);
  const SurfaceDisk disk{p_T, R_TW * cloud.normal(number), disk_radius_ratio_ * cloud.spacing_m(number),
                         sample_field(tool, p_T)};
  const double distance_m = disk.at.distance_m;
  if (distance_m > limits.reach) return;
  all.nearest_distance_m = std::min(all.nearest_distance_m, distance_m);
  const Voxel voxel = distance_m <= limits.voxels ? finder.voxel(p_T) : Voxel::free;
  const bool is_touched =
      lower_bound_m(disk) <= limits.touch && nearest_position(tool, disk).at.distance_m <= limits.touch;
  if (voxel != Voxel::free || is_touched)
    add_touched(p_T, voxel == Voxel::interior ? ContactState::entrenched : ContactState::contact, all);
}

void TouchedPoints::add_touched(const Vec3& p_T, ContactState state, Touched& all) {
  all.state = std::max(all.state, state);
  ++all.points;
  clusters_[cluster_count_++] = cell_number(p_T, kClustersPer_m);
}

}  // namespace remote_touch
