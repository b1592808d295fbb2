// The true surface around the action, where the scene is a height field: its height over a grid at some
// times.
#pragma once

#include <vector>

#include "core/geometry/bounding_box.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

struct TrueHeights {
  static constexpr int kColumns = 41;  // along x and along z
  std::vector<double> time_s;          // one, where the surface does not move
  std::vector<float> height_m;         // y; x runs fastest, then z, then time; NaN: not known
  bool empty() const { return height_m.empty(); }
};

// Empty where the height is known nowhere. Of a surface that moves there are at most 200 times.
TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, double from_s, double to_s);

}  // namespace remote_touch
