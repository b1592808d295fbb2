#include "core/dissertation/sphere_tree/region_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace remote_touch {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Number of pairs from which the contacts are chosen when the tool is deep in regions.
constexpr std::size_t kMaxToThin = ContactThinning::kSlots / 2;

}  // namespace

RegionContacts::RegionContacts(std::shared_ptr<const SphereTree> tool, double look_ahead_m,
                               const Kernels& kernels)
    : tool_(std::move(tool)),
      look_ahead_m_(look_ahead_m),
      collision_(*tool_, kernels),
      choice_(look_ahead_m, kernels),
      deepest_(tool_->leaves().size(), kNone) {
  contacts_.reserve(ContactThinning::kMaxCount);
  others_.reserve(kMaxToThin);
}

void RegionContacts::on_frame(std::shared_ptr<const RegionTree> regions) {
  regions_ = std::move(regions);
  collision_.on_frame(regions_->spheres());
  std::fill(deepest_.begin(), deepest_.end(), kNone);
}

void RegionContacts::reserve(std::size_t points) {
  collision_.reserve(points, points / RegionTree::kPatchPoints + 1);
}

// Returns an upper bound of the smallest gap of a leaf: its gap to this region; infinity for kNone.
double RegionContacts::bound_m(const CloseLeaf& leaf, std::uint32_t region) const {
  if (region == kNone) return kInfinite;
  const Sphere& other = regions_->spheres().leaves()[region];
  return (leaf.sphere_W.centre - other.centre).norm() - leaf.sphere_W.radius_m - other.radius_m;
}

// Makes the contact of a pair, in the tool frame.
ToolContact RegionContacts::contact(const ChosenPair& pair, const Eigen::Quaterniond& q_TW) const {
  const Vec3 n_T = q_TW * pair.n_W;
  const Sphere& leaf = tool_->leaves()[pair.leaf];
  return {leaf.centre - leaf.radius_m * n_T, n_T, -pair.gap_m, 1};
}

// The gap to any region is an upper bound of a leaf's smallest gap. Two regions give good bounds: the one in
// which the leaf was deepest at the last query, and the one in which the leaf before it is deepest now. The
// bound limits the query; deep inside the regions, to half of all pairs. It does not change the choice of
// pairs.
NearContacts RegionContacts::near(const ToolPose& pose, double, double) {
  choice_.begin();
  std::uint32_t neighbours = kNone;
  double min_m = kInfinite;
  for (const CloseLeaf& leaf : collision_.close_leaves(pose, look_ahead_m_)) {
    std::uint32_t& deepest = deepest_[leaf.number];
    const double within_m = choice_.within_m(std::min(bound_m(leaf, deepest), bound_m(leaf, neighbours)));
    const TreeCollision::Found found = collision_.regions_near(leaf, within_m);
    if (found.count == 0) continue;
    deepest = neighbours = choice_.choose(leaf, found);
  }
  for (const ChosenPair& pair : choice_.chosen()) min_m = std::min(min_m, pair.gap_m);
  if (choice_.chosen().size() > ContactThinning::kMaxCount)
    choice_.keep_shortest_motions(choice_.is_deep(min_m) ? kMaxToThin : ContactThinning::kMaxCount);
  take_contacts(pose.q_WT.conjugate());
  return {contacts_, -min_m};
}

// Makes the contacts. If there are too many pairs, half of the contacts are the most urgent pairs, because
// these hold a tool that is wedged.
void RegionContacts::take_contacts(const Eigen::Quaterniond& q_TW) {
  constexpr std::size_t kHalf = ContactThinning::kMaxCount / 2;
  const std::span<const ChosenPair> chosen = choice_.chosen();
  const std::size_t as_they_are = chosen.size() > ContactThinning::kMaxCount ? kHalf : chosen.size();
  contacts_.clear(), others_.clear();
  for (const ChosenPair& pair : chosen.first(as_they_are)) contacts_.push_back(contact(pair, q_TW));
  for (const ChosenPair& pair : chosen.subspan(as_they_are)) others_.push_back(contact(pair, q_TW));
  thinning_.thin(others_, kHalf);
  contacts_.insert(contacts_.end(), others_.begin(), others_.end());
}

// The query needs no pairs beyond the smallest gap found so far, unless they touch, because they change no
// result.
RegionTouch RegionContacts::touched(const ToolPose& pose, double own_stiffness_N_per_m) {
  RegionTouch touch{kInfinite, 0, 0, own_stiffness_N_per_m};
  double weights = 0, weighted = 0;
  for (const CloseLeaf& leaf : collision_.close_leaves(pose, std::max(look_ahead_m_, kTouch_m))) {
    const TreeCollision::Found found =
        collision_.regions_near(leaf, std::max(kTouch_m, std::min(look_ahead_m_, touch.nearest_distance_m)));
    const int before = touch.leaf_pairs;
    for (std::size_t i = 0; i < found.count; ++i) {
      const double gap_m = found.regions.gap[i];
      touch.nearest_distance_m = std::min(touch.nearest_distance_m, gap_m);
      if (gap_m > kTouch_m) continue;
      ++touch.leaf_pairs;
      const double weight = std::min((kTouch_m - gap_m) / (2 * kTouch_m), 1.0);
      const double stiffness = regions_->stiffness_N_per_m(found.regions.number[i]);
      weights += weight;
      weighted += weight * (std::isnan(stiffness) ? own_stiffness_N_per_m : stiffness);
    }
    touch.touching_leaf_count += touch.leaf_pairs > before ? 1 : 0;
  }
  if (touch.nearest_distance_m > look_ahead_m_) touch.nearest_distance_m = kInfinite;
  if (weights > 0) touch.stiffness_N_per_m = weighted / weights;
  return touch;
}

}  // namespace remote_touch
