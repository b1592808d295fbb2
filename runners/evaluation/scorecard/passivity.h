// The passivity audit: closed cycles of a simulated hand with every choice of signs in the renderers' force
// laws, to find which of them feed energy into the hand.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "runners/evaluation/scorecard/benchmark.h"

namespace remote_touch {

// Scenes of the audit. A HIP presses and slides. A tool does the same, and also presses, tilts and turns.
inline constexpr const char* kPassivityScenes[] = {"passivity", "tool-passivity-slide",
                                                   "tool-passivity-turn"};
inline bool is_passivity_scene(const std::string& name) {
  return std::find(std::begin(kPassivityScenes), std::end(kPassivityScenes), name) !=
         std::end(kPassivityScenes);
}
inline constexpr int kPassivityCycles = 3;  // number of cycles in a run of such a scene

// Returns the method with each combination of those parameters of its renderer that affect energy: without
// and with a damper k_d (4.16), its sign where there is one, and the sign of the velocity term of (4.15) if a
// velocity is estimated. The name is METHOD, then what differs from the method's own: "proxy+v_plus+k_d3".
// The method itself is the first.
std::vector<Method> force_laws_of(const Method& method);

}  // namespace remote_touch
