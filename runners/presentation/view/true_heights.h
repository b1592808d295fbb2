// The true surface around the action, where the scene is a height field: its height over a grid at some
// times. It is the surface from which the column signed_distance measures.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/bounding_box.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

struct TrueHeights {
  static constexpr int kColumns = 41;  // along x and along z
  // The truth is the surface at the last capture: it stays until the next of these times. Otherwise it moves
  // evenly from one to the next.
  bool stays = false;
  std::vector<double> time_s;   // one, where the surface does not move
  std::vector<float> height_m;  // y; x runs fastest, then z, then time; NaN: not known
  bool empty() const { return height_m.empty(); }
};

// time_s: of the ticks, at least one. Empty where the height is known nowhere. Of a surface that moves evenly
// there are at most 200 times, of one that stays all at which it changes, but at most 2000.
TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s);

}  // namespace remote_touch
