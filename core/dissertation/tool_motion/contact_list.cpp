#include "core/dissertation/tool_motion/contact_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/mesh/distance_field.h"

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

constexpr double kShortest = 1e-5;  // parts of a path shorter than this fraction are not halved again
constexpr double kSpare_m = 1e-9;   // more than the rounding of the field on a path

// A cubic on [from, until] by its Bernstein coefficients.
struct Cubic {
  double b[4];

  // Returns the cubic with the values f at both ends and at one and two thirds.
  static Cubic through(const double (&f)[4]) {
    return {{f[0], (-5 * f[0] + 18 * f[1] - 9 * f[2] + 2 * f[3]) / 6,
             (2 * f[0] - 9 * f[1] + 18 * f[2] - 5 * f[3]) / 6, f[3]}};
  }
  double least() const { return std::min(std::min(b[0], b[1]), std::min(b[2], b[3])); }
  void halve(Cubic& first, Cubic& second) const {  // de Casteljau
    const double c01 = 0.5 * (b[0] + b[1]), c12 = 0.5 * (b[1] + b[2]), c23 = 0.5 * (b[2] + b[3]);
    const double c02 = 0.5 * (c01 + c12), c13 = 0.5 * (c12 + c23), middle = 0.5 * (c02 + c13);
    first = {{b[0], c01, c02, middle}};
    second = {{middle, c13, c23, b[3]}};
  }
};

// Returns the first fraction at which a cubic can be below min_m, to within kShortest; 1 if it cannot on this
// part, or only beyond `limit`.
double first_below(const Cubic& cubic, double min_m, double from, double until, double limit) {
  if (from > limit || cubic.least() >= min_m) return 1;
  if (until - from <= kShortest) return from;
  Cubic first, second;
  cubic.halve(first, second);
  const double middle = 0.5 * (from + until), found = first_below(first, min_m, from, middle, limit);
  return found < 1 ? found : first_below(second, min_m, middle, until, limit);
}

// Returns the fraction beyond `from` at which a path crosses the next plane between cells; 1, its end, if
// there is none.
double next_plane(const Vec3& start, const Vec3& along, double from) {
  constexpr double kOnPlane = 1e-9;
  double next = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) continue;
    const double at = start[axis] + from * along[axis];
    const double plane = along[axis] > 0 ? std::floor(at + kOnPlane) + 1 : std::ceil(at - kOnPlane) - 1;
    next = std::min(next, (plane - start[axis]) / along[axis]);
  }
  return next;
}

constexpr std::size_t kMaxStops = 64;
constexpr double kSamePoint_m = 1e-9;
constexpr double kMinSlope = 0.3;  // a smaller slope is at a ridge, where the field is not reliable

// Returns the nearest of the points that can stop the tool; 0 if there is none. pre: there is a point.
std::size_t nearest_outside(const NearPoints& points) {
  std::size_t nearest = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance_m = points.distance_m(i);
    if (distance_m >= -ClearWay::kInside_m && distance_m < least_m) least_m = distance_m, nearest = i;
  }
  return nearest;
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

ClearWay::ClearWay(const VoxelTool& tool)
    : tool_(tool), slopes_(tool.grid, tool.distance_m), max_slope_(max_slope(tool.grid, tool.distance_m)) {}

double ClearWay::safe_motion_m(double look_ahead_m) const {
  return (std::min(look_ahead_m, kExactField_m) - kTouch_m) / max_slope_;
}

ClearWay::Motion::Motion(const ToolPose& from, const Vector6& a_g) {
  const Vector6 in_tool = rotated(from.q_WT.conjugate(), a_g);
  a_T = in_tool.head<3>();
  shift_m = a_T.norm(), turn_rad = in_tool.tail<3>().norm();
  turned = rotation(-in_tool.tail<3>()).toRotationMatrix();
}

// The curve is rotation(-s alpha) (p - s a): its second derivative is no more than
// |alpha|^2 |p - s a| + 2 |alpha| |a|.
double ClearWay::fraction(const Motion& motion, const Vec3& p_T, double distance_m, double limit) const {
  const Vec3 end_T = motion.turned * (p_T - motion.a_T), along_T = end_T - p_T;
  const double bent =
      motion.turn_rad * (motion.turn_rad * (p_T.norm() + motion.shift_m) + 2 * motion.shift_m);
  const double bend_m = 0.5 * max_slope_ * bent, size_m = tool_.grid.size_m;
  // A path that is clear up to `end` has no first part that begins at `limit` or before.
  const double end = std::min(limit + 2 * kShortest, 1.0);
  const double spare_m = distance_m - kTouch_m - bend_m / 4 - (end < 1 ? kSpare_m : 0);
  if (max_slope_ * end * along_T.norm() < spare_m || distance_m < -kInside_m) return 1;
  Chord chord{(p_T - tool_.grid.origin_T) / size_m, along_T / size_m, bend_m, std::min(kTouch_m, distance_m)};
  if (spare_m > 0 && slopes_.min_change_m(chord.from, end * chord.along) > -spare_m) return 1;
  return first_below(chord, limit);
}

SlabWay ClearWay::slab_way(const Motion& motion, double far_m) const {
  SlabWay way{{}, {}, motion.shift_m, motion.turn_rad, max_slope_, far_m, kTouch_m, {}};
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < 3; ++k) way.turned[axis][k] = motion.turned(axis, k);
    way.a_T[axis] = motion.a_T[axis];
  }
  return way;
}

// Steps from cell to cell along the chord. Returns the fraction at which the field can first be too low; 1 if
// it cannot, or only beyond `limit`.
double ClearWay::first_below(const Chord& chord, double limit) const {
  constexpr double kRounding_m = 1e-12;  // the field at the start is computed in two ways that differ by less
  for (double from = 0; from < 1 && from <= limit;) {
    const double until = next_plane(chord.from, chord.along, from);
    const Vec3 middle = chord.from + 0.5 * (from + until) * chord.along;
    std::array<int, 3> cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<int>(std::floor(middle[static_cast<int>(axis)]));
      if (cell[axis] < 0 || cell[axis] >= tool_.grid.cells[axis]) return 1;  // beyond the margin of the field
    }
    const CellField field(tool_.grid, tool_.distance_m, cell);
    const Vec3 start = chord.from - Vec3(cell[0], cell[1], cell[2]);
    double value[4];
    for (int i = 0; i < 4; ++i) {
      const double s = from + (until - from) * i / 3;
      value[i] = field(start + s * chord.along) - chord.bend_m * s * (1 - s);
    }
    const double found =
        remote_touch::first_below(Cubic::through(value), chord.min_m - kRounding_m, from, until, limit);
    if (found < 1) return found;
    from = until;
  }
  return 1;
}

ContinuousContacts::ContinuousContacts(const ToolParameters& parameters, const VoxelTool& tool)
    : tool_(tool),
      reach_m_(tool.reach_m + kFieldMargin_m + 3 * tool.grid.size_m),
      way_(tool),
      max_motion_m_(way_.safe_motion_m(parameters.look_ahead_m)) {
  contacts_.reserve(MotionProgram::kMaxContacts + kMaxStops);
  stops_W_.reserve(kMaxStops);
}

void ContinuousContacts::begin(ContactList& points) {
  points_ = &points;
  stops_W_.clear();
}

void ContinuousContacts::add_stops(const ToolPose& pose) {
  for (const Vec3& p_W : stops_W_) {
    const Vec3 p_T = pose.q_WT.conjugate() * (p_W - pose.p_W);
    const FieldSample at = sample_field(tool_, p_T);
    const double slope = at.gradient_T.norm();
    if (slope < kMinSlope) continue;
    contacts_.push_back({p_T, -at.gradient_T / slope, (kGap_m - at.distance_m) / slope, 0});
  }
}

void ContinuousContacts::add_stop(const Vec3& p_W) {
  const bool is_known = std::any_of(stops_W_.begin(), stops_W_.end(),
                                    [&](const Vec3& stop_W) { return (stop_W - p_W).norm() < kSamePoint_m; });
  if (!is_known && stops_W_.size() < kMaxStops) stops_W_.push_back(p_W);
}

NearContacts ContinuousContacts::near(const ToolPose& pose, double side, double) {
  const NearContacts found = points_->near(pose, side);
  contacts_.clear();
  for (ToolContact contact : found.contacts) {
    contact.depth_m += kGap_m;
    contacts_.push_back(contact);
  }
  thinning_.thin(contacts_, ContactThinning::kMaxCount - stops_W_.size());
  add_stops(pose);
  return {contacts_, found.deepest_m + kGap_m};
}

bool ContinuousContacts::has_points_inside(const ToolPose& pose) const {
  return points_->has_point_below(pose, -ClearWay::kInside_m);
}

double ContinuousContacts::known_fraction(const Vector6& a_g) const {
  const double motion_m = max_point_displacement_m(a_g, reach_m_);
  return motion_m > max_motion_m_ ? max_motion_m_ / motion_m : 1;
}

// ahead_W: direction away from which the normals of points can be left out; zero: all matter.
const NearPoints& ContinuousContacts::on_way(const ToolPose& pose, const ClearWay::Motion& motion,
                                             const Vec3& ahead_W) const {
  SlabWay way = way_.slab_way(motion, way_.far_m(motion, reach_m_));
  std::copy_n(ahead_W.data(), 3, way.ahead_W);
  return points_->points_on_way(pose, way);
}

double ContinuousContacts::clear_fraction(const ToolPose& pose, const Vector6& a_g) {
  const ClearWay::Motion motion(pose, a_g);
  double clear = known_fraction(a_g);
  const NearPoints& points = on_way(pose, motion, Vec3::Zero());
  const TiledCloud& cloud = points_->finder().cloud().packed();
  std::size_t first = points.size();
  const auto add = [&](std::size_t i) {
    const double fraction = way_.fraction(motion, points.p_T(i), points.distance_m(i), clear);
    // The stop does not depend on the order: of equal ones it is the first point of the cloud.
    const bool is_first =
        fraction < clear || (fraction == clear && first < points.size() &&
                             cloud.number(points.number(i)) < cloud.number(points.number(first)));
    if (is_first) clear = fraction, first = i;
  };
  // The nearest point often stops the tool first. Then most others need no search.
  if (points.size() > 0) add(nearest_outside(points));
  for (std::size_t i = 0; i < points.size(); ++i) add(i);
  if (first < points.size()) add_stop(pose.p_W + pose.q_WT * points.p_T(first));
  return clear;
}

double ContinuousContacts::fraction_ahead(const ToolPose& pose, const Vector6& a_g, double side) const {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  const ClearWay::Motion motion(pose, a_g);
  double clear = known_fraction(a_g);
  const NearPoints& points = on_way(pose, motion, side * a_g.head<3>());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 n_T = R_TW * points_->finder().cloud().packed().normal(points.number(i));
    if (!(side * n_T.dot(motion.a_T) < 0)) continue;
    if (points.distance_m(i) < -ClearWay::kInside_m) return 0;
    clear = std::min(clear, way_.fraction(motion, points.p_T(i), points.distance_m(i), clear));
  }
  return clear;
}

}  // namespace remote_touch
