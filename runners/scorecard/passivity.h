// The passivity audit: closed cycles of a simulated hand with every choice of signs in the renderers' force
// laws, to find which of them feed energy into the hand.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "runners/scorecard/benchmark.h"

namespace remote_touch {

// For a HIP: press and slide. For a tool: the same, and press, tilt and turn.
inline constexpr const char* kPassivityScenes[] = {"passivity", "tool-passivity-slide",
                                                   "tool-passivity-turn"};
inline bool is_passivity_scene(const std::string& name) {
  return std::find(std::begin(kPassivityScenes), std::end(kPassivityScenes), name) !=
         std::end(kPassivityScenes);
}
inline constexpr int kPassivityCycles = 3;  // in a run of such a scene

// The method with each combination of those of its renderer's parameters that affect energy: without and with
// a damper k_d (4.16), its sign where there is one, and the sign of the velocity term of (4.15) if a velocity
// is estimated. Named METHOD, then what differs from the method's own: "proxy+v_plus+k_d3". The method itself
// is the first.
std::vector<Method> force_laws_of(const Method& method);

}  // namespace remote_touch
