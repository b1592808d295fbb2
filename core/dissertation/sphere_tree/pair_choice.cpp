#include "core/dissertation/sphere_tree/pair_choice.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

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

}  // namespace remote_touch
