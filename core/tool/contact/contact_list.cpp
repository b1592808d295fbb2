#include "core/tool/contact/contact_list.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace remote_touch {

namespace {

// The collision list reaches a little less far than the field.
constexpr double kMaxReach_m = kFieldMargin_m - 2e-4;
constexpr double kTouch_m = 1e-4;       // a disk closer to the tool than this is touched
constexpr double kSearch_m = 3e-4;      // a disk closer than this has its nearest place searched
constexpr double kClustersPer_m = 100;  // touching points within a centimetre are counted as one cluster

// No place of the disk is nearer than this to a convex tool; where nothing is left to search, none as near.
double bound_m(const NearDisks& disks, std::size_t i) {
  const bool exact = disks.lower_m(i) <= kSearch_m && disks.is_flat(i);
  return exact ? disks.distance_m(i) : disks.lower_m(i);
}

}  // namespace

ContactList::ContactList(std::shared_ptr<const VoxelTool> tool, const ToolParameters& parameters,
                         const Kernels& kernels)
    : p_(parameters),
      kernels_(kernels),
      finder_(std::move(tool), kernels),
      disks_(parameters.disk_radius_ratio, ContactThinning::kCell_m),
      merged_disks_(parameters.disk_radius_ratio, ContactThinning::kCell_m) {}

void ContactList::on_frame(std::shared_ptr<const TiledCloud> cloud) {
  finder_.on_frame(std::move(cloud));
  const TiledCloud& points = finder_.cloud();
  max_disk_m_ = p_.disk_radius_ratio * points.max_spacing_m();
  reserve(points.padded_size());
  disks_.on_frame(points);
  const TiledCloud* merged = used_merged_disk_m(p_) > 0 ? points.merged() : nullptr;
  is_merged_ = merged != nullptr;
  max_near_disk_m_ = max_disk_m_;
  if (!merged) return;
  merged_disks_.on_frame(*merged);
  max_near_disk_m_ = p_.disk_radius_ratio * merged->max_spacing_m() + merged->max_extent_m();
}

void ContactList::reserve(std::size_t padded_size) {
  finder_.reserve(padded_size), disks_.reserve(padded_size);
  if (used_merged_disk_m(p_) > 0) merged_disks_.reserve(padded_size);
  contacts_.reserve(2 * padded_size), collisions_.reserve(padded_size);
  near_.reserve(padded_size), nearest_.reserve(padded_size), others_.reserve(padded_size);
  chosen_.reserve(padded_size);
  clusters_.reserve(padded_size);
}

std::span<const ToolContact> ContactList::thinned(std::vector<ToolContact>& contacts) {
  thinning_.thin(contacts);
  return contacts;
}

void ContactList::gather_near(double reach_m) {
  const NearDisks& disks = near_disks();
  near_.resize(disks.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < disks.size(); ++i) {  // without a branch: which are near is hard to foresee
    near_[count] = {bound_m(disks, i), static_cast<std::uint32_t>(i), 0};
    const bool is_near = (disks.lower_m(i) <= p_.look_ahead_m) & (disks.distance_m(i) <= reach_m);
    count += is_near ? 1 : 0;
  }
  near_.resize(count);
}

void ContactList::append_contacts(double side) {
  near_ones().append_contacts(chosen_, finder_, kernels_, kSearch_m, side, contacts_);
}

// The nearest disk of every cell of the tool, by their bounds.
void ContactList::gather_cells() {
  thinning_.begin();
  nearest_.clear();
  std::uint64_t last_key = 0;
  std::size_t last_cell = ContactThinning::kNoCell;
  for (NearDisk& near : near_) {
    const std::uint64_t key = near_disks().cell(near.disk);
    const std::size_t cell =
        key == last_key && last_cell != ContactThinning::kNoCell ? last_cell : thinning_.cell(key);
    last_key = key, last_cell = cell;
    near.cell = static_cast<std::uint32_t>(cell);
    if (cell == ContactThinning::kNoCell) continue;
    if (cell == nearest_.size())
      nearest_.push_back(near);
    else if (near.bound_m < nearest_[cell].bound_m)
      nearest_[cell] = near;
  }
}

// Of every cell the deepest contact, with as few searches as their bounds allow: there can be thousands of
// disks, and only the deepest of a cell is made into a contact.
void ContactList::gather_deepest(double side) {
  gather_cells();
  chosen_.clear();
  for (const NearDisk& near : nearest_) chosen_.push_back(near.disk);
  append_contacts(side);
  chosen_.clear(), others_.clear();
  for (const NearDisk& near : near_) {
    const bool can_be_deeper = near.cell < nearest_.size() && near.disk != nearest_[near.cell].disk &&
                               -near.bound_m > contacts_[near.cell].depth_m;
    if (can_be_deeper) chosen_.push_back(near.disk), others_.push_back(near);
  }
  append_contacts(side);
  for (std::size_t k = 0; k < others_.size(); ++k) {
    const ToolContact& other = contacts_[nearest_.size() + k];
    ToolContact& deepest = contacts_[others_[k].cell];
    if (-others_[k].bound_m > deepest.depth_m && other.depth_m > deepest.depth_m) deepest = other;
  }
  contacts_.resize(nearest_.size());
}

NearContacts ContactList::near(const ToolPose& pose, double side) {
  const double reach_m = std::min(p_.look_ahead_m + max_near_disk_m_, kMaxReach_m);
  NearContacts found{{}, -std::numeric_limits<double>::infinity()};
  contacts_.clear();
  near_ones().query(finder_, kernels_, pose, reach_m);
  gather_near(reach_m);
  if (near_.size() > ContactThinning::kMaxCount) {
    gather_deepest(side);
  } else {
    chosen_.clear();
    for (const NearDisk& near : near_) chosen_.push_back(near.disk);
    append_contacts(side);
  }
  for (const ToolContact& contact : contacts_) found.deepest_m = std::max(found.deepest_m, contact.depth_m);
  found.contacts = thinned(contacts_);
  return found;
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

// The nearest place of a disk is no farther from the tool than its centre, so most need no search.
bool ContactList::is_touched(std::size_t i) const {
  if (disks_.lower_m(i) > kTouch_m) return false;
  return disks_.distance_m(i) <= kTouch_m ||
         (!disks_.is_flat(i) && nearest_place(finder_.tool(), disks_.disk(i)).at.distance_m <= kTouch_m);
}

void ContactList::add_cluster(const Vec3& p_T) {
  constexpr std::size_t kRecent = 4;  // neighbours mostly follow each other
  const std::uint64_t cell = cell_number(p_T, kClustersPer_m);
  const std::size_t first = clusters_.size() > kRecent ? clusters_.size() - kRecent : 0;
  for (std::size_t k = first; k < clusters_.size(); ++k)
    if (clusters_[k] == cell) return;
  clusters_.push_back(cell);
}

// No voxel of the tool is farther from its surface than two edges of a voxel, so that points and disks
// farther away need not be known, unless none is nearer.
Touched ContactList::touched(const ToolPose& pose) {
  const bool disks = p_.contact_rule != TouchRule::voxels;
  const double voxels_m = 2 * finder_.tool().grid.size_m, shown_m = std::max(p_.look_ahead_m, voxels_m);
  const double disk_m = disks ? max_disk_m_ : 0;
  Touched all = touched_within(pose, std::min(std::max(voxels_m, kTouch_m + disk_m), kMaxReach_m));
  if (all.nearest_distance_m > voxels_m) all = touched_within(pose, std::min(shown_m + disk_m, kMaxReach_m));
  if (all.nearest_distance_m > shown_m) all.nearest_distance_m = std::numeric_limits<double>::infinity();
  return all;
}

Touched ContactList::touched_within(const ToolPose& pose, double reach_m) {
  const bool disks = p_.contact_rule != TouchRule::voxels;
  const double voxels_m = 2 * finder_.tool().grid.size_m;
  Touched all;
  all.nearest_distance_m = std::numeric_limits<double>::infinity();
  clusters_.clear();
  disks_.query(finder_, kernels_, pose, reach_m);
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    if (disks_.distance_m(i) > reach_m) continue;  // which of these are kept depends on the poses before
    all.nearest_distance_m = std::min(all.nearest_distance_m, disks_.distance_m(i));
    const Voxel voxel = disks_.distance_m(i) <= voxels_m ? finder_.voxel(disks_.p_T(i)) : Voxel::free;
    if (voxel == Voxel::free && !(disks && is_touched(i))) continue;
    all.state =
        std::max(all.state, voxel == Voxel::interior ? ContactState::entrenched : ContactState::contact);
    ++all.points;
    add_cluster(disks_.p_T(i));
  }
  std::sort(clusters_.begin(), clusters_.end());
  all.clusters = static_cast<int>(std::unique(clusters_.begin(), clusters_.end()) - clusters_.begin());
  return all;
}

}  // namespace remote_touch
