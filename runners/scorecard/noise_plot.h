// A small picture for the page: the share of successes over noise, a line for each method.
#pragma once

#include <string>
#include <vector>

#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

// Of a method, by its place; the same everywhere on the page.
const char* method_colour(std::size_t method);

// Inline SVG. Noise levels stand at equal distances, and methods beside each other, so that their
// intervals can be told apart.
std::string noise_plot(const SceneScore& scene, const std::vector<std::string>& methods);

// Of a noise level, in units of r_c; "own" for that of the scene.
std::string level_text(double noise_m);

}  // namespace remote_touch
