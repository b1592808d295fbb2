#include "core/dissertation/tool_motion/near_points.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "core/dissertation/tool_motion/contact_thinning.h"

namespace remote_touch {
namespace {

using disk_search::kCuts;
using disk_search::kEdgeOnSine;
using disk_search::kFlatSlope;
using disk_search::kLines;
using disk_search::kMinGradient;
using disk_search::kStep_m;

Vec3 slope_in_plane(const SurfaceDisk& disk, const FieldSample& at) {
  return at.gradient_T - at.gradient_T.dot(disk.n_T) * disk.n_T;
}

// Moves `position` down the field in the plane of the disk, to the lowest position on a line that begins
// there. Returns true if the position moved. The field of a convex tool is convex along a line, and over an
// edge it is nearly a pair of straight lines. So the intersection of the tangents at the two ends is a better
// end (Kelley's cutting planes).
bool slide(const VoxelTool& tool, const SurfaceDisk& disk, DiskPosition& position) {
  const Vec3 along = slope_in_plane(disk, position.at);
  const double steep = along.norm();
  if (is_flat(steep, disk.radius_m, disk.extent_m)) return false;
  const Vec3 start_T = position.p_T, direction_T = -along / steep, offset = start_T - disk.p_T;
  // The rim is at |offset + t direction| = radius.
  const double ahead = offset.dot(direction_T), inside = disk.radius_m * disk.radius_m - offset.squaredNorm();
  struct End {
    double t;
    FieldSample at;
    double slope;
  };
  const auto end = [&](double t) {
    const FieldSample at = sample_field(tool, start_T + t * direction_T);
    return End{t, at, at.gradient_T.dot(direction_T)};
  };
  End low{0, position.at, -steep}, high = end(std::sqrt(std::max(0.0, ahead * ahead + inside)) - ahead);
  position.at_rim = high.slope < -kFlatSlope && high.at.distance_m < low.at.distance_m;
  for (int cut = 0; cut < kCuts && !position.at_rim && high.slope - low.slope > kFlatSlope; ++cut) {
    const double meet = (low.at.distance_m - high.at.distance_m + high.slope * high.t - low.slope * low.t) /
                        (high.slope - low.slope);
    if (!(meet > low.t && meet < high.t)) break;
    const End between = end(meet);
    (between.slope < 0 ? low : high) = between;
  }
  const End& best = high.at.distance_m <= low.at.distance_m ? high : low;
  position.p_T = start_T + best.t * direction_T;
  position.at = best.at;
  // The gradients on both sides of an edge are combined into one that has no slope along the line. Only this
  // combination gives the side of a disk that meets the edge at a grazing angle.
  if (!position.at_rim && low.slope < 0 && high.slope > low.slope) {
    const double fraction = std::clamp(high.slope / (high.slope - low.slope), 0.0, 1.0);
    position.at.gradient_T = fraction * low.at.gradient_T + (1 - fraction) * high.at.gradient_T;
  }
  return best.t > 0;
}

// Returns the side of a disk on which a flat tool lies that is flush with a flat surface: +1 or -1; 0 if it
// is not clear. Disks beside such a tool lie in the plane of its face. Their contacts would otherwise act as
// walls against the tool's sides. If the field rises over a step of kStep_m to one side of the plane, the
// tool is not on that side.
double side_of_flush(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPosition& position) {
  const auto rises_beyond = [&](double side) {
    const Vec3 beyond = position.p_T - side * kStep_m * disk.n_T;
    return sample_field(tool, beyond).distance_m - position.at.distance_m > 0.5 * kStep_m;
  };
  const bool front = rises_beyond(1), back = rises_beyond(-1);
  return front == back ? 0 : front ? 1 : -1;
}

// Returns the side of the disk on which the tool is according to the field: +1 for the side of the sensor, -1
// for the other; 0 if the disk meets the tool edge-on.
double facing_side(const SurfaceDisk& disk, const FieldSample& at, double steep) {
  const double facing = -at.gradient_T.dot(disk.n_T);
  if (std::abs(facing) <= kEdgeOnSine * steep) return 0;
  return facing < 0 ? -1 : 1;
}

// Returns the side of the disk on which the tool is. It is known_side if the position is in the tool and the
// side is known, else facing_side().
double side_of(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPosition& position,
               double known_side) {
  if (position.at.distance_m < 0 && known_side != 0) return known_side;
  const double steep = position.at.gradient_T.norm();
  // A short gradient deep inside the tool belongs to a ridge of the field, where the side cannot be
  // determined; +1 is assumed. The depth is checked because the gradient is also short at a corner of the
  // tool.
  if (position.at.distance_m < -tool.grid.size_m && steep < kMinGradient) return 1;
  return facing_side(disk, position.at, steep);
}

// Returns the unit direction in which the tool leaves the position soonest; +y if the field is flat there.
Vec3 exit_direction(const FieldSample& at, double steep) {
  return steep > 0 ? Vec3(-at.gradient_T / steep) : Vec3(Vec3::UnitY());
}

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

double lower_bound_m(const SurfaceDisk& disk) {
  if (!disk.has_normal()) return disk.at.distance_m;
  return disk.at.distance_m - disk.radius_m * slope_in_plane(disk, disk.at).norm();
}

DiskPosition nearest_position(const VoxelTool& tool, const SurfaceDisk& disk) {
  DiskPosition position{disk.p_T, disk.at};
  if (!disk.has_normal() || !(disk.radius_m > 0)) return position;
  for (int line = 0; line < kLines && slide(tool, disk, position) && !position.at_rim; ++line) continue;
  return position;
}

ToolContact near_contact(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPosition& nearest,
                         double known_side) {
  double side = disk.has_normal() ? side_of(tool, disk, nearest, known_side) : 0;
  const bool known = nearest.at.distance_m < 0 && known_side != 0;
  bool as_plane = side != 0 && (!nearest.at_rim || known);
  if (!as_plane && disk.has_normal()) {
    const double flush = side_of_flush(tool, disk, nearest);
    if (flush != 0) side = flush, as_plane = true;
  }
  const Vec3 out =
      as_plane ? Vec3(side * disk.n_T) : exit_direction(nearest.at, nearest.at.gradient_T.norm());
  return {nearest.p_T, out, -nearest.at.distance_m, side};
}

ToolContact far_contact(const SurfaceDisk& disk, double lower_bound_m) {
  assert(lower_bound_m > 0);
  const double steep = disk.at.gradient_T.norm();
  const double side = disk.has_normal() ? facing_side(disk, disk.at, steep) : 0;
  return {disk.p_T, exit_direction(disk.at, steep), -lower_bound_m, side};
}

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
  count_ = kernels.tool.disks_in_field(points, point_count_, {disk_radius_ratio_, cells_per_m_}, field_,
                                       limits, {nearest_.data(), is_new_}, columns(), outside_count);
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

void KeptGroups::reserve(std::size_t padded_size) {
  groups_.grow(padded_size / kLanes + 1), nearest_m_.grow(padded_size / kLanes + kLanes);
  searched_m_ = -1;
}

void KeptGroups::search(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  searched_at_ = pose, searched_m_ = remote_touch::searched_m(reach_m, kSpare_m);
  const TiledCloud& cloud = finder.cloud().packed();
  is_new_ = true;
  const std::span<const std::uint32_t> found =
      cloud.has_slabs() ? finder.slabs_within(cloud, pose, searched_m_, nearest_m_.data())
                        : finder.groups_within(cloud, pose, searched_m_);
  count_ = found.size();
  if (!cloud.has_slabs())
    std::fill_n(nearest_m_.data(), count_, -std::numeric_limits<double>::infinity());  // not known
  std::copy(found.begin(), found.end(), groups_.data());
}

// Drops the groups without a point within searched_m_.
void KeptGroups::drop_far_groups() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    groups_[kept] = groups_[i], nearest_m_[kept] = nearest_m_[i];
    kept += nearest_m_[i] > searched_m_ ? 0 : 1;
  }
  count_ = kept;
}

GroupsInReach KeptGroups::within(const TouchFinder& finder, const ToolPose& pose, double reach_m) {
  if (!(searched_m_ - max_change_m(finder, searched_at_, pose) > reach_m)) search(finder, pose, reach_m);
  is_new_ = is_new_ && pose == searched_at_;  // nearest_m_ belongs to that pose
  return {groups_.data(), count_, nearest_m_.data(), is_new_,
          remote_touch::passed_m(reach_m, max_change_m(finder, searched_at_, pose))};
}

void KeptGroups::on_measured() {
  if (is_new_) drop_far_groups();
  is_new_ = false;
}

void NearPoints::reserve(std::size_t padded_size) {
  groups_.reserve(padded_size), points_.grow(padded_size + kLanes);
  on_way_.index.grow(padded_size / kLanes + 1), on_way_.group.grow(padded_size / kLanes + 1);
  on_way_.nearest_m.grow(padded_size / kLanes + 1);
  count_ = 0;
}

void NearPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                       double reach_m) {
  measure(finder, kernels, pose, reach_m, groups_.within(finder, pose, reach_m));
  groups_.on_measured();
}

void NearPoints::query(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                       const SlabWay& way) {
  if (!finder.cloud().packed().has_slabs()) return query(finder, kernels, pose, way.far);
  const GroupsInReach all = groups_.within(finder, pose, way.far);
  const PosedField field = posed_field(finder.tool(), pose);
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.count; ++i) {
    on_way_.index[count] = static_cast<std::uint32_t>(i);
    count += all.nearest_m[i] > all.passed_m ? 0 : 1;
  }
  for (const int parts : {1, 2, 4})
    count = kernels.tool.slabs_on_way(
        finder.cloud().packed().slabs(),
        {all.group, on_way_.index.data(), count, all.nearest_m, all.passed_m - way.far}, field,
        finder.slopes(), way, parts, on_way_.index.data());
  for (std::size_t i = 0; i < count; ++i) {
    on_way_.group[i] = all.group[on_way_.index[i]];
    on_way_.nearest_m[i] = all.nearest_m[on_way_.index[i]];
  }
  measure(finder, kernels, pose, way.far,
          {on_way_.group.data(), count, on_way_.nearest_m.data(), all.is_new, all.passed_m});
  for (std::size_t i = 0; all.is_new && i < count; ++i)
    all.nearest_m[on_way_.index[i]] = on_way_.nearest_m[i];
  groups_.on_measured();
}

// Measures the points in portions, because the first portion of a surface in the tool mostly has one.
bool NearPoints::has_below(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                           double value_m, double search_m) {
  constexpr std::size_t kPortion = 64;
  const GroupsInReach all = groups_.within(finder, pose, search_m);
  const double passed_m = all.passed_m - search_m + value_m;
  for (std::size_t first = 0; first < all.count; first += kPortion) {
    measure(finder, kernels, pose, value_m,
            {all.group + first, std::min(kPortion, all.count - first), all.nearest_m + first, all.is_new,
             passed_m});
    for (std::size_t i = 0; i < count_; ++i)
      if (distance_m(i) < value_m) return true;
  }
  groups_.on_measured();
  return false;
}

void NearPoints::measure(const TouchFinder& finder, const Kernels& kernels, const ToolPose& pose,
                         double reach_m, const GroupsInReach& groups) {
  std::size_t outside_count = 0;
  count_ = kernels.tool.points_in_field(
      finder.cloud().packed().columns(), groups.group, groups.count, posed_field(finder.tool(), pose),
      {reach_m, groups.passed_m}, {groups.nearest_m, groups.is_new},
      {{points_[kX], points_[kY], points_[kZ]}, points_[kDistance], points_[kNumber]}, outside_count);
  if (outside_count > 0) finish_outside(finder.tool(), reach_m);
}

// Completes the points for which the kernel wrote NaN, because they lie less than a cell outside the grid.
// Drops the points beyond reach_m.
void NearPoints::finish_outside(const VoxelTool& tool, double reach_m) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::isnan(distance_m(i))) points_[kDistance][i] = sample_field(tool, p_T(i)).distance_m;
    if (distance_m(i) > reach_m) continue;
    for (std::size_t column = 0; column < kColumns; ++column) points_[column][kept] = points_[column][i];
    ++kept;
  }
  count_ = kept;
}

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
                              {disk_radius_ratio_, kClustersPer_m}, posed_field(finder.tool(), pose),
                              finder.voxels(), limits, {groups.nearest_m, groups.is_new}, sum);
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
      {p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]}, numbers.size(), {disk_radius_ratio_, kClustersPer_m},
      field, {kInfinite, kInfinite, kInfinite, kInfinite}, {nearest_m, true}, disks, outside_count);
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
