// Selection of the pairs of leaves that become constraints, (7.4): far more are near than the motion program
// can handle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/dissertation/sphere_tree/tree_collision.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

// A pair that is a constraint: n . u >= -gap for the motion u of the leaf's centre.
struct ChosenPair {
  std::uint32_t leaf;  // leaf of the tool
  double gap_m;
  Vec3 n_W;  // unit, out of the region
  // Shortest motion of the leaf that can violate the constraint and still obeys the deeper ones of the leaf.
  // It is the gap for a deep leaf, and until it is computed.
  double motion_m;
};

// All pairs of one leaf limit the motion of one point, its centre. They are visited from the deepest on, and
// a pair is kept unless a pair that is already kept makes it redundant. Pair j with the gap g_j is redundant
// if some deeper pair i has g_j - g_i >= |n_j - n_i| m, because then no motion up to the length m that obeys
// i violates j.
//
// If the leaf is no deeper than half the look-ahead, m is half the look-ahead. validate() of the renderer's
// settings refuses longer steps, so no pair is lost that a step could run into. A looser rule would be wrong.
// An example is the obtuse crease of two regions 1 mm apart: the pole of either region lies 9 um deep in the
// other region and 0.8 mm aside, and a tool that is limited by one region at a time moves back and forth
// between them.
//
// A deeper leaf is on its way out, or in a wedge, and its steps are longer, so m is twice the look-ahead.
// Pair j is dropped only if its normal is also within kAlike of that of i, so that the deepest pair of every
// direction is kept. A pair is also dropped if it is less than half as deep as the deepest one and not within
// a look-ahead of it; the next query finds it.
//
// The deepest pair of every leaf is kept, so no dropped pair is deeper than all that are kept. If a leaf has
// more than kMaxPairsOfLeaf pairs, the shallower ones are lost. When the list has no room for another leaf
// (kCapacity pairs), half of kCapacity is kept: the pairs that the shortest motions can violate. Pairs of
// deep leaves are compared by their gaps, so the deepest are kept. Allocates on construction only.
class PairChoice {
 public:
  static constexpr std::size_t kMaxPairsOfLeaf = 64, kCapacity = 4096;
  static constexpr double kAlike = 0.90630778703664996;  // cosine of 25 degrees

  PairChoice(double look_ahead_m, const Kernels& kernels);

  void begin();
  // Returns the largest gap that a kept pair of a leaf can have, if the leaf's deepest pair has a gap of
  // gap_m or less.
  double within_m(double gap_m) const;
  // Adds the pairs of a leaf to chosen(). found: all pairs of the leaf with gaps up to within_m(). Returns
  // the number of its deepest region; pre: found is not empty.
  std::uint32_t choose(const CloseLeaf& leaf, const TreeCollision::Found& found);

  std::span<const ChosenPair> chosen() const { return chosen_; }
  // Keeps at most max pairs: those that the shortest motions can violate, sorted by that motion.
  void keep_shortest_motions(std::size_t max);
  bool is_deep(double gap_m) const { return gap_m < -motion_m_; }

 private:
  void rate();

  const double look_ahead_m_, motion_m_;
  const Kernels& kernels_;
  std::vector<ChosenPair> chosen_;
  std::size_t rated_ = 0;  // number of the first pairs whose motion_m is known
};

}  // namespace remote_touch
