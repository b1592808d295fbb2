#include "core/sphere_tree/region_contacts.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace remote_touch {

namespace {

std::size_t way_number(const Vec3& way) {
  const Vec3 along = way.cwiseAbs();
  const std::size_t largest =
      along.x() >= along.y() ? (along.x() >= along.z() ? 0 : 2) : (along.y() >= along.z() ? 1 : 2);
  const std::size_t octant = (way.x() < 0 ? 4u : 0u) | (way.y() < 0 ? 2u : 0u) | (way.z() < 0 ? 1u : 0u);
  return 3 * octant + largest;
}

}  // namespace

RegionContacts::RegionContacts(std::shared_ptr<const SphereTree> tool, double look_ahead_m)
    : tool_(std::move(tool)),
      look_ahead_m_(look_ahead_m),
      collision_(*tool_),
      deepest_(kWays * tool_->leaves().size()) {
  chosen_.reserve(deepest_.size());
  contacts_.reserve(std::max(ContactThinning::kMost, deepest_.size()));
}

Vec3 RegionContacts::way_out_W(const LeafPair& pair) const {
  return collision_.tool_leaf(pair.tool).centre - regions_.spheres().leaves()[pair.region].centre;
}

void RegionContacts::choose_deepest(std::span<const LeafPair> pairs) {
  ++detection_;
  chosen_.clear();
  for (const LeafPair& pair : pairs) {
    const std::size_t at = kWays * pair.tool + way_number(way_out_W(pair));
    Deepest& deepest = deepest_[at];
    if (deepest.detection != detection_)
      deepest = {pair, detection_}, chosen_.push_back(static_cast<std::uint32_t>(at));
    else if (pair.gap_m < deepest.pair.gap_m)
      deepest.pair = pair;
  }
}

// In the tool frame. Centres that coincide tell no way: up is as good as any.
ToolContact RegionContacts::contact(const LeafPair& pair, const ToolPose& pose) const {
  const Eigen::Quaterniond q_TW = pose.q_WT.conjugate();
  const Vec3 way_W = way_out_W(pair);
  const double length_m = way_W.norm();
  const Vec3 n_T = q_TW * (length_m > 0 ? Vec3(way_W / length_m) : Vec3(Vec3::UnitY()));
  const Sphere& leaf = tool_->leaves()[pair.tool];
  return {leaf.centre - leaf.radius_m * n_T, n_T, -pair.gap_m, 1};
}

NearContacts RegionContacts::near(const ToolPose& pose, double) {
  const std::span<const LeafPair> pairs = collision_.near(pose, regions_.spheres(), look_ahead_m_);
  contacts_.clear();
  if (pairs.size() <= ContactThinning::kMost) {
    for (const LeafPair& pair : pairs) contacts_.push_back(contact(pair, pose));
  } else {
    choose_deepest(pairs);
    for (const std::uint32_t at : chosen_) contacts_.push_back(contact(deepest_[at].pair, pose));
  }
  NearContacts found{{}, -std::numeric_limits<double>::infinity()};
  for (const ToolContact& contact : contacts_) found.deepest_m = std::max(found.deepest_m, contact.depth_m);
  thinning_.thin(contacts_);
  found.contacts = contacts_;
  return found;
}

}  // namespace remote_touch
