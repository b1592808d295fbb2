// The true surface around the action, where the scene is a height field: its height over a grid at some
// times. It is the surface from which the column signed_distance measures.
#pragma once

#include <span>
#include <vector>

#include "core/points/vector.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

struct TrueHeights {
  static constexpr int kColumns = 41;  // along x and along z
  // true: the truth is the surface at the last capture, which stays until the next of these times. false: the
  // surface moves evenly from one of these times to the next.
  bool stays = false;
  std::vector<double> time_s;   // one, where the surface does not move
  std::vector<float> height_m;  // y; x runs fastest, then z, then time; NaN: not known
  // The largest difference between the drawn sheet and the surface that was found: half-way between the times
  // (if the surface moves evenly between them), and half-way between the nodes at three of the times. m.
  // It is no bound: elsewhere the sheet may be off by more.
  double error_m = 0;
  bool empty() const { return height_m.empty(); }
};

// time_s: the times of the ticks, at least one. Returns an empty result if the height is known nowhere. A
// surface that moves evenly has at most 200 times, and up to 600 if the sheet would be off by more than 0.2
// mm half-way between them. One that stays has all times at which it changes, but at most 2000.
TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s);

}  // namespace remote_touch
