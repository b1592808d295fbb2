#include "core/tool/contact_list.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

namespace {

// The collision list reaches a little less far than the field.
constexpr double kLongestReach_m = kFieldMargin_m - 2e-4;
constexpr double kTouch_m = 1e-4;    // a disk closer to the tool than this is touched
constexpr double kSearch_m = 3e-4;   // a disk closer than this has its nearest place searched
constexpr double kCluster_m = 0.01;  // touching points closer than this are counted as one cluster

// A step turns the tool by so little that two points of 4 mm ask for the same motion within a tenth of a
// millimetre; what is left over the next detection finds. Larger cells where these are still too many:
// contacts have to stay spread over the tool.
constexpr double kCell_m = 4e-3, kCellGrowth = 1.5;
constexpr auto kMost = static_cast<std::size_t>(MotionProgram::kMostContacts);

}  // namespace

ContactList::ContactList(std::shared_ptr<const VoxelTool> tool, const ToolParameters& parameters,
                         const Kernels& kernels)
    : p_(parameters), kernels_(kernels), finder_(std::move(tool), kernels), disks_(parameters.disk_share) {}

void ContactList::on_frame(const PointCloud& cloud) {
  finder_.on_frame(cloud);
  const TiledCloud& points = finder_.cloud();
  widest_disk_m_ = 0;
  for (std::uint32_t i = 0; i < points.room(); ++i)
    widest_disk_m_ = std::max(widest_disk_m_, p_.disk_share * points.spacing_m(i));
  contacts_.reserve(points.room()), collisions_.reserve(points.room());
  near_.reserve(points.room()), behind_.reserve(points.room());
  clusters_.reserve(points.room());
  disks_.on_frame(points);
}

std::span<const ToolContact> ContactList::thinned(std::vector<ToolContact>& contacts) {
  for (double cell_m = kCell_m; contacts.size() > kMost; cell_m *= kCellGrowth)
    thinning_.thin(contacts, cell_m);
  return contacts;
}

bool ContactList::is_worth_a_search(std::size_t disk) const {
  return disks_.lower_m(disk) <= kSearch_m;
}

ToolContact ContactList::contact(std::size_t i, double side) const {
  const SurfaceDisk disk = disks_.disk(i);
  if (!is_worth_a_search(i)) return far_contact(disk, disks_.lower_m(i));
  const VoxelTool& tool = finder_.tool();
  const DiskPlace nearest = disks_.is_flat(i) ? DiskPlace{disk.p_T, disk.at} : nearest_place(tool, disk);
  return near_contact(tool, disk, nearest, side);
}

// What thinned() would leave of all contacts, in cells of kCell_m: of most of those far away it is enough to
// know that something deeper lies beside them.
void ContactList::gather_deepest(double side) {
  constexpr auto kMade = ~std::uint32_t{0};
  thinning_.begin(kCell_m);
  behind_.clear();
  for (const std::uint32_t i : near_) {
    const bool far = !is_worth_a_search(i);
    ToolContact contact;
    if (!far) contact = this->contact(i, side);
    const std::size_t place =
        far ? thinning_.place(disks_.p_T(i), -disks_.gradient_T(i), -disks_.lower_m(i))
            : thinning_.place(contact.r_T, contact.n_T, contact.depth_m);
    if (place == ContactThinning::kNowhere) continue;
    if (place == behind_.size()) behind_.push_back(kMade), contacts_.emplace_back();
    behind_[place] = far ? i : kMade;
    if (!far) contacts_[place] = contact;
  }
  for (std::size_t place = 0; place < behind_.size(); ++place)
    if (behind_[place] != kMade) contacts_[place] = contact(behind_[place], side);
}

NearContacts ContactList::near(const ToolPose& pose, double side) {
  const double reach_m = std::min(p_.look_ahead_m + widest_disk_m_, kLongestReach_m);
  NearContacts found{{}, -std::numeric_limits<double>::infinity()};
  contacts_.clear(), near_.clear();
  disks_.look(finder_, kernels_, pose, reach_m);
  for (std::size_t i = 0; i < disks_.size(); ++i)
    if (disks_.lower_m(i) <= p_.look_ahead_m) near_.push_back(static_cast<std::uint32_t>(i));
  if (near_.size() > kMost)
    gather_deepest(side);
  else
    for (const std::uint32_t i : near_) contacts_.push_back(contact(i, side));
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

Touched ContactList::touched(const ToolPose& pose) {
  const bool disks = p_.contact_rule == TouchRule::look_ahead;
  const double shown_m = std::max(p_.look_ahead_m, 2 * finder_.tool().grid.size_m);
  const double reach_m = std::min(shown_m + (disks ? widest_disk_m_ : 0), kLongestReach_m);
  Touched all;
  all.nearest_m = std::numeric_limits<double>::infinity();
  clusters_.clear();
  disks_.look(finder_, kernels_, pose, reach_m);
  for (std::size_t i = 0; i < disks_.size(); ++i) {
    all.nearest_m = std::min(all.nearest_m, disks_.distance_m(i));
    // No voxel of the tool is farther from its surface than that.
    const bool may_be_in = disks_.distance_m(i) <= 2 * finder_.tool().grid.size_m;
    const Voxel voxel = may_be_in ? finder_.voxel(disks_.p_T(i)) : Voxel::free;
    if (voxel == Voxel::free && !(disks && disks_.lower_m(i) <= kTouch_m &&
                                  nearest_place(finder_.tool(), disks_.disk(i)).at.distance_m <= kTouch_m))
      continue;
    all.state =
        std::max(all.state, voxel == Voxel::interior ? ContactState::entrenched : ContactState::contact);
    ++all.points;
    clusters_.push_back(cell_number(disks_.p_T(i), kCluster_m));
  }
  if (all.nearest_m > shown_m) all.nearest_m = std::numeric_limits<double>::infinity();
  std::sort(clusters_.begin(), clusters_.end());
  all.clusters = static_cast<int>(std::unique(clusters_.begin(), clusters_.end()) - clusters_.begin());
  return all;
}

}  // namespace remote_touch
