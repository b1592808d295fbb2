// A small picture for the page: the share of successes over noise, a line for each contender.
#pragma once

#include <string>
#include <vector>

#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

// Of a contender, by its place; the same everywhere on the page.
const char* contender_colour(std::size_t contender);

// Inline SVG. Noise levels stand at equal distances, and contenders beside each other, so that their
// intervals can be told apart.
std::string noise_plot(const SceneScore& scene, const std::vector<std::string>& contenders);

// Of a noise level, in units of r_c; "own" for that of the scene.
std::string level_text(double noise_m);

}  // namespace remote_touch
