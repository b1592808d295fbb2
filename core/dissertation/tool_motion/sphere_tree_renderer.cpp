#include "core/dissertation/tool_motion/sphere_tree_renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace remote_touch {
namespace {

static_assert(SphereTree::kBranching <= 32, "the topmost nodes are the bits of a word");

constexpr double kRoundingOfSums = 1 + 1e-12;  // factor on sums: no region within the margin is skipped

// True if some region below a node may be within the margin. The test needs no root, and no extra branch for
// NaN: a sphere with NaN is never near, because cwiseMax() keeps a NaN on its left.
bool is_near(const Sphere& a, const SphereNode& node, double margin_m) {
  const SphereBox& box = node.box;
  const double reach_m = (a.radius_m + box.max_radius_m + margin_m) * kRoundingOfSums;
  const Vec3 beyond = (box.low - a.centre).cwiseMax(a.centre - box.high).cwiseMax(0);
  return reach_m >= 0 && beyond.squaredNorm() <= reach_m * reach_m;
}

}  // namespace

TreeCollision::TreeCollision(const SphereTree& tool, const Kernels& kernels)
    : tool_(tool), kernels_(kernels) {
  close_.reserve(tool.leaves().size());
}

void TreeCollision::on_frame(const SphereTree& regions) {
  regions_ = &regions;
  reserve(regions.leaves().size(), regions.empty() ? 0 : regions.level(0).size());
}

void TreeCollision::reserve(std::size_t leaves, std::size_t patches) {
  if (!tool_.empty()) patches_.reserve(tool_.level(0).size() * patches);
  const std::size_t pairs = leaves + 2 * kLanes;
  if (number_.size() >= pairs) return;
  for (std::vector<double>* column : {&gap_, &nx_, &ny_, &nz_}) column->resize(pairs);
  number_.resize(pairs);
}

Sphere TreeCollision::placed(const Sphere& sphere_T) const {
  return {p_W_ + R_WT_ * sphere_T.centre, sphere_T.radius_m};
}

std::uint32_t TreeCollision::tops_near(const Sphere& sphere_W, std::uint32_t among) const {
  std::uint32_t near = 0;
  for (; among != 0; among &= among - 1) {
    const int top = std::countr_zero(among);
    if (is_near(sphere_W, regions_->top()[static_cast<std::size_t>(top)], margin_m_)) near |= 1u << top;
  }
  return near;
}

std::span<const CloseLeaf> TreeCollision::close_leaves(const ToolPose& pose, double margin_m) {
  close_.clear(), patches_.clear();
  if (tool_.empty() || !regions_ || regions_->empty()) return {};
  p_W_ = pose.p_W, R_WT_ = pose.q_WT.toRotationMatrix(), margin_m_ = margin_m;
  const auto every_top = static_cast<std::uint32_t>((std::uint64_t{1} << regions_->top().size()) - 1);
  for (std::uint32_t node = 0; node < tool_.top().size(); ++node)
    meet_tool(tool_.level_count() - 1, node, every_top);
  return close_;
}

void TreeCollision::meet_tool(std::size_t level, std::uint32_t number, std::uint32_t tops) {
  const SphereNode& node = tool_.level(level)[number];
  const Sphere node_W = placed(node.sphere);
  tops = tops_near(node_W, tops);
  if (tops == 0) return;
  if (level > 0) {
    for (std::uint32_t child = node.first; child < node.first + node.count; ++child)
      meet_tool(level - 1, child, tops);
    return;
  }
  const auto first_patch = static_cast<std::uint32_t>(patches_.size());
  for (; tops != 0; tops &= tops - 1)
    meet_regions(regions_->level_count() - 1, static_cast<std::uint32_t>(std::countr_zero(tops)), node_W);
  const auto patch_count = static_cast<std::uint32_t>(patches_.size()) - first_patch;
  if (patch_count == 0) return;
  for (std::uint32_t leaf = node.first; leaf < node.first + node.count; ++leaf)
    close_.push_back({leaf, first_patch, patch_count, placed(tool_.leaves()[leaf])});
}

void TreeCollision::meet_regions(std::size_t level, std::uint32_t number, const Sphere& node_W) {
  const SphereNode& node = regions_->level(level)[number];
  if (!is_near(node_W, node, margin_m_)) return;
  if (level == 0) return patches_.push_back(number);
  for (std::uint32_t child = node.first; child < node.first + node.count; ++child)
    meet_regions(level - 1, child, node_W);
}

TreeCollision::Found TreeCollision::regions_near(const CloseLeaf& leaf, double margin_m) {
  Found found{{gap_.data(), nx_.data(), ny_.data(), nz_.data(), number_.data()}, 0};
  const Vec3& middle = leaf.sphere_W.centre;
  const double columns[4] = {middle.x(), middle.y(), middle.z(), leaf.sphere_W.radius_m};
  for (std::uint32_t i = leaf.first_patch; i < leaf.first_patch + leaf.patch_count; ++i)
    if (is_near(leaf.sphere_W, regions_->level(0)[patches_[i]], margin_m))
      found.count = kernels_.regions.append_near_regions(regions_->run(patches_[i]), columns, margin_m,
                                                         found.regions, found.count);
  return found;
}

PairChoice::PairChoice(double look_ahead_m, const Kernels& kernels)
    : look_ahead_m_(look_ahead_m), motion_m_(0.5 * look_ahead_m), kernels_(kernels) {
  chosen_.reserve(kCapacity);
}

void PairChoice::begin() {
  chosen_.clear();
  rated_ = 0;
}

// A motion of half the look-ahead cannot violate a pair whose gap is larger than that. It also cannot violate
// a pair whose gap is larger than the deepest one's by twice that motion, because normals differ by 2 at
// most. The result grows with gap_m, so an upper bound of the deepest gap is enough.
double PairChoice::within_m(double gap_m) const {
  if (gap_m > motion_m_) return std::min(gap_m, look_ahead_m_);
  return std::min(motion_m_, std::max(gap_m + 2 * motion_m_, 0.5 * gap_m));
}

std::uint32_t PairChoice::choose(const CloseLeaf& leaf, const TreeCollision::Found& found) {
  assert(found.count > 0);
  if (chosen_.size() + kMaxPairsOfLeaf > kCapacity) keep_shortest_motions(kCapacity / 2);
  const NearRegions& near = found.regions;
  RemainingRegions left{kernels_.regions.deepest_region(near, found.count), found.count};
  const std::uint32_t deepest = near.number[left.deepest];
  const double min_m = near.gap[left.deepest], max_m = within_m(min_m);
  const bool deep = is_deep(min_m);
  constexpr double kAny = -2;  // below every cosine
  const double motion_m = deep ? 2 * look_ahead_m_ : motion_m_, alike = deep ? kAlike : kAny;
  for (std::size_t kept = 0; kept < kMaxPairsOfLeaf && left.deepest < left.count; ++kept) {
    const std::size_t at = left.deepest;
    chosen_.push_back({leaf.number, near.gap[at], {near.nx[at], near.ny[at], near.nz[at]}, near.gap[at]});
    left = kernels_.regions.next_deepest_region(near, left.count, at, motion_m, alike, max_m);
  }
  return deepest;
}

// Computes motion_m of the pairs that were added last. The pairs of a leaf are sorted: the deepest comes
// first.
void PairChoice::rate() {
  std::size_t first = rated_;
  for (; rated_ < chosen_.size(); ++rated_) {
    ChosenPair& pair = chosen_[rated_];
    if (pair.leaf != chosen_[first].leaf) first = rated_;
    if (is_deep(chosen_[first].gap_m)) continue;
    double max_squared = 0;
    for (std::size_t i = first; i < rated_; ++i) {
      const double gap_difference_m = pair.gap_m - chosen_[i].gap_m,
                   apart_squared = (pair.n_W - chosen_[i].n_W).squaredNorm();
      if (apart_squared > 0)
        max_squared = std::max(max_squared, gap_difference_m * gap_difference_m / apart_squared);
    }
    pair.motion_m = std::max(pair.gap_m, max_squared > 0 ? std::sqrt(max_squared) : pair.gap_m);
  }
}

void PairChoice::keep_shortest_motions(std::size_t max) {
  rate();
  const auto is_sooner = [](const ChosenPair& a, const ChosenPair& b) {
    if (a.motion_m != b.motion_m) return a.motion_m < b.motion_m;
    return a.leaf != b.leaf ? a.leaf < b.leaf : a.gap_m < b.gap_m;
  };
  std::sort(chosen_.begin(), chosen_.end(), is_sooner);
  if (chosen_.size() > max) chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(max), chosen_.end());
  rated_ = chosen_.size();
}

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

namespace {

double reach_m(const SphereTree& spheres) {
  double reach = 0;
  for (const Sphere& leaf : spheres.leaves()) reach = std::max(reach, leaf.centre.norm() + leaf.radius_m);
  return reach;
}

ContactState state_of(double gap_m) {
  if (gap_m < -RegionContacts::kTouch_m) return ContactState::entrenched;
  return gap_m < RegionContacts::kTouch_m ? ContactState::contact : ContactState::free;
}

}  // namespace

Parameters region_parameters(ToolParameters& p) {
  return without(parameters(p),
                 {"contact_rule", "free_accuracy_m", "exit_accuracy_m", "disk_radius_ratio", "merged_disk_m",
                  "frame_reach_m", "velocity_estimate", "max_prediction_s", "velocity_force"});
}

Parameters SphereTreeRenderer::live_parameters() {
  return live_ones(region_parameters(p_));
}

SphereTreeRenderer::SphereTreeRenderer(const ToolParameters& parameters,
                                       std::shared_ptr<const VoxelTool> tool,
                                       const std::shared_ptr<const SphereTree>& spheres,
                                       const Kernels& kernels)
    : p_(parameters),
      tool_(std::move(tool)),
      kernels_(kernels),
      contacts_(spheres, parameters.look_ahead_m, kernels),
      motion_(parameters, *tool_, reach_m(*spheres)),
      slave_(parameters.slave_command) {}

void SphereTreeRenderer::prepare(Frame& frame) const {
  frame.prepared = prepared_form<RegionTree>(*frame.points, kernels_);
}

void SphereTreeRenderer::reserve(std::size_t points) {
  contacts_.reserve(points);
}

void SphereTreeRenderer::on_frame(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return;
  contacts_.on_frame(form_of<RegionTree>(frame, kernels_));
  updated_ = true;
}

// Moves the tool by one tick of the quasi-static motion, 7.4.2.
void SphereTreeRenderer::follow(const ToolPose& device, RenderOutput& out) {
  const ToolMotionReport report = motion_.move(pose_, device, contacts_, std::exchange(updated_, false));
  take_report(report, normal_W_, out);
}

RenderOutput SphereTreeRenderer::step(const DeviceState& device, double) {
  RenderOutput out;
  out.frame_index = order_.newest();
  out.tool.emplace();
  const std::optional<ToolPose> target = device_pose(device);
  if (!target) {
    out.status = RenderStatus::device_not_finite;  // the tool rests and the force is zero
  } else {
    if (!placed_) pose_ = *target, placed_ = true;
    if (order_.newest() < 0) {
      pose_ = *target;
      out.converged = true;
      out.status = RenderStatus::no_frame;
    } else {
      follow(*target, out);
    }
  }
  const RegionTouch touch = contacts_.touched(pose_, p_.stiffness_N_per_m);
  if (target) {
    const Wrench wrench =
        coupling_wrench(coupling_of(p_, touch.stiffness_N_per_m), tool_->inertia_m2, pose_, *target);
    out.force_N = wrench.force_N;
    out.tool->torque_Nm = wrench.torque_Nm;
  }
  out.proxy_W = pose_.p_W;
  if (placed_) out.slave_W = slave_.command_W(pose_, target);
  out.tool->orientation_W = pose_.q_WT;
  out.normal_W = normal_W_;
  out.state = state_of(touch.nearest_distance_m);
  out.nearest_distance_m = touch.nearest_distance_m;
  out.contact_count = touch.leaf_pairs;
  out.tool->contact_clusters = touch.touching_leaf_count;
  out.tool->tool_penetration_m = std::max(0.0, -touch.nearest_distance_m);
  out.status = order_.status(out.status);
  return out;
}

}  // namespace remote_touch
