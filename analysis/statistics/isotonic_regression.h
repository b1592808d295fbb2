// A curve that is known to fall, from noisy values.
#pragma once

#include <vector>

namespace remote_touch {

// The falling values nearest to the given ones by least squares with weights (pool adjacent violators).
std::vector<double> isotonic_falling(const std::vector<double>& values, const std::vector<double>& weights);

// Where a falling curve over rising x crosses the level, by linear interpolation; the first x when it begins
// below the level, the last when it ends above.
double crossing(const std::vector<double>& x, const std::vector<double>& falling, double level);

}  // namespace remote_touch
