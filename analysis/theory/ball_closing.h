// The surface that a ball can touch: the morphological closing of a profile with a ball, the oracle of Fig
// 4.14.
#pragma once

#include <vector>

namespace remote_touch {

// heights[i] is the profile at position i * spacing. The closing at a position is the lowest point that a
// ball of that radius, rolled over the profile from above, can reach there; never below the profile. The
// ball's centre is tried at the samples only, for which the result is exact. Within a radius of the ends the
// ball rests on the samples that exist. All lengths in one unit.
std::vector<double> ball_closing(const std::vector<double>& heights, double spacing, double radius);

}  // namespace remote_touch
