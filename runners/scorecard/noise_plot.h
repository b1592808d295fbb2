// A small plot for the page: the fraction of successes over noise, one line for each method.
#pragma once

#include <string>
#include <vector>

#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

// The colour of a method by its index; the same everywhere on the page.
const char* method_colour(std::size_t method);

// Inline SVG. Noise levels are equally spaced, and methods side by side, so that their intervals do not
// overlap.
std::string noise_plot(const SceneScore& scene, const std::vector<std::string>& methods);

// A noise level as text, in units of r_c; "own" for that of the scene.
std::string level_text(double noise_m);

}  // namespace remote_touch
