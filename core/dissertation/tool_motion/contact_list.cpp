#include "core/dissertation/tool_motion/contact_list.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace remote_touch {
namespace {

constexpr double kRounding = 1 + 1e-5;  // larger than the rounding of normals
// Detection reaches a little less far than the field.
constexpr double kMaxReach_m = kFieldMargin_m - 2e-4;

// Returns cell_and_octant() in cells whose edges are longer by the factor 2^doublings. Each of the three
// coordinates has 20 bits; the octant has the last three.
std::uint64_t in_larger_cells(std::uint64_t cell_and_octant, int doublings) {
  constexpr std::uint64_t kLastOfEach =
      std::uint64_t{1} << 43 | std::uint64_t{1} << 23 | std::uint64_t{1} << 3;
  return cell_and_octant & ~(kLastOfEach * ((std::uint64_t{1} << doublings) - 1));
}

}  // namespace

ContactList::ContactList(std::shared_ptr<const VoxelTool> tool, const ToolParameters& parameters,
                         const Kernels& kernels)
    : p_(parameters),
      kernels_(kernels),
      finder_(std::move(tool), kernels),
      disks_(parameters.disk_radius_ratio, ContactThinning::kCell_m),
      touched_(parameters.disk_radius_ratio, parameters.contact_rule != ContactRule::voxels) {}

void ContactList::on_frame(std::shared_ptr<const TiledCloud> cloud) {
  finder_.on_frame(std::move(cloud));
  const TiledCloud& points = finder_.cloud();
  max_disk_m_ = p_.disk_radius_ratio * points.max_spacing_m();
  reserve(points.padded_size());
  touched_.on_frame(), points_.on_frame();
  const TiledCloud* merged = used_merged_disk_m(p_) > 0 ? points.merged() : nullptr;
  disks_.on_frame(merged ? *merged : points);
  max_near_disk_m_ =
      merged ? p_.disk_radius_ratio * merged->max_spacing_m() + merged->max_extent_m() : max_disk_m_;
}

void ContactList::reserve(std::size_t padded_size) {
  finder_.reserve(padded_size), disks_.reserve(padded_size), touched_.reserve(padded_size);
  if (p_.contact_rule == ContactRule::continuous) points_.reserve(padded_size);
  contacts_.reserve(2 * padded_size), collisions_.reserve(padded_size);
  cells_.reserve(padded_size);
  nearest_.reserve(ContactThinning::kSlots);
  chosen_.reserve(padded_size);
}

std::span<const ToolContact> ContactList::thinned(std::vector<ToolContact>& contacts) {
  thinning_.thin(contacts);
  return contacts;
}

void ContactList::append_contacts(double side) {
  disks_.append_contacts(chosen_, finder_, kernels_, side, contacts_);
}

// Finds the nearest disk of every cell of the tool; disks are compared by their bounds. If there is no room
// for all cells, it begins again with larger ones.
void ContactList::gather_cells() {
  const NearDisks& disks = disks_;
  int doublings = 0;
  const auto begin = [&] { thinning_.begin(), nearest_.clear(); };
  begin();
  cells_.resize(disks.size());
  for (std::uint32_t disk = 0; disk < disks.size(); ++disk) {
    const std::size_t cell = thinning_.cell(in_larger_cells(disks.cell(disk), doublings));
    if (cell == ContactThinning::kNoCell) {
      ++doublings, begin(), disk = ~std::uint32_t{0};
      continue;
    }
    cells_[disk] = static_cast<std::uint32_t>(cell);
    const double bound_m = disks.bound_m(disk);
    if (cell == nearest_.size()) nearest_.push_back({bound_m, disk});
    Nearest& nearest = nearest_[cell];
    const bool is_nearer = bound_m < nearest.bound_m;  // no branch: it would be hard to predict
    nearest.bound_m = is_nearer ? bound_m : nearest.bound_m;
    nearest.disk = is_nearer ? disk : nearest.disk;
  }
}

// Computes the deepest contact of every cell with as few searches as the bounds of the disks allow. There can
// be thousands of disks, and only the deepest one of a cell becomes a contact.
void ContactList::gather_deepest(double side) {
  const NearDisks& disks = disks_;
  gather_cells();
  chosen_.clear();
  for (const Nearest& nearest : nearest_) chosen_.push_back(nearest.disk);
  append_contacts(side);
  chosen_.clear();
  for (std::uint32_t disk = 0; disk < disks.size(); ++disk) {
    const std::uint32_t cell = cells_[disk];
    const bool can_be_deeper = disk != nearest_[cell].disk && -disks.bound_m(disk) > contacts_[cell].depth_m;
    if (can_be_deeper) chosen_.push_back(disk);
  }
  append_contacts(side);
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const ToolContact& other = contacts_[nearest_.size() + i];
    ToolContact& deepest = contacts_[cells_[chosen_[i]]];
    const double bound_m = disks.bound_m(chosen_[i]);
    if (-bound_m > deepest.depth_m && other.depth_m > deepest.depth_m) deepest = other;
  }
  contacts_.resize(nearest_.size());
}

NearContacts ContactList::near(const ToolPose& pose, double side, double within_m) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // A disk in a notch of the tool can be deeper than its lower bound. So all disks within kSearch_m are
  // included.
  const double near_m = std::min(std::max(within_m, NearDisks::kSearch_m), p_.look_ahead_m);
  NearContacts found{{}, -kInfinite, near_m < p_.look_ahead_m ? near_m : kInfinite};
  contacts_.clear();
  disks_.query(finder_, kernels_, pose, std::min(near_m + max_near_disk_m_, kMaxReach_m), near_m);
  if (disks_.size() > ContactThinning::kMaxCount) {
    gather_deepest(side);
  } else {
    chosen_.resize(disks_.size());
    std::iota(chosen_.begin(), chosen_.end(), 0u);
    append_contacts(side);
  }
  for (const ToolContact& contact : contacts_) found.deepest_m = std::max(found.deepest_m, contact.depth_m);
  found.contacts = thinned(contacts_);
  return found;
}

bool ContactList::has_point_below(const ToolPose& pose, double value_m) {
  return points_.has_below(finder_, kernels_, pose, value_m, std::min(p_.look_ahead_m, max_single_m()));
}

const NearPoints& ContactList::points_on_way(const ToolPose& pose, SlabWay way) {
  way.far = std::min(way.far, max_single_m());
  points_.query(finder_, kernels_, pose, way);
  return points_;
}

double ContactList::max_single_m() const {
  return std::min(p_.look_ahead_m + max_disk_m_, kMaxReach_m);
}

VoxelContacts ContactList::in_voxels(const ToolPose& pose) {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  const TiledCloud& cloud = finder_.cloud();
  VoxelContacts found;
  contacts_.clear(), collisions_.clear();
  for (const std::uint32_t point : finder_.in_tool(pose)) {
    const Vec3 n_W = cloud.normal(point);
    if (!n_W.allFinite()) continue;
    const Vec3 p_T = R_TW * (cloud.point(point) - pose.p_W);
    const bool inside = finder_.voxel(p_T) == Voxel::interior;
    found.touched = true, found.collided |= inside;
    (inside ? collisions_ : contacts_).push_back({p_T, R_TW * n_W, inside ? 1.0 : 0.0, 1});
  }
  found.contacts = thinned(found.collided ? collisions_ : contacts_);
  return found;
}

// The first query covers the points that can be in a voxel or have a touched disk. Points farther away are
// queried only if it finds no point within two voxels of the tool.
Touched ContactList::touched(const ToolPose& pose) {
  const double voxels_m = 2 * finder_.tool().grid.size_m, shown_m = std::max(p_.look_ahead_m, voxels_m);
  const double disk_m = p_.contact_rule == ContactRule::voxels ? 0 : max_disk_m_;
  const auto within = [&](double reach_m) {
    return touched_.query(finder_, kernels_, pose, std::min(reach_m, kMaxReach_m), voxels_m);
  };
  const double needed_m = std::max(std::min(finder_.max_voxel_m(), voxels_m),
                                   TouchedPoints::kTouch_m + kRounding * finder_.max_slope() * disk_m);
  Touched all = within(std::min(needed_m, std::max(voxels_m, TouchedPoints::kTouch_m + disk_m)));
  if (all.nearest_distance_m > voxels_m) all = within(shown_m + disk_m);
  if (all.nearest_distance_m > shown_m) all.nearest_distance_m = std::numeric_limits<double>::infinity();
  return all;
}

}  // namespace remote_touch
