// A decreasing curve from noisy values.
#pragma once

#include <vector>

namespace remote_touch {

// Returns the decreasing values nearest to the given ones by weighted least squares (pool adjacent
// violators). Equal neighbours count as decreasing.
std::vector<double> isotonic_falling(const std::vector<double>& values, const std::vector<double>& weights);

// Returns the x at which a decreasing curve over increasing x crosses the level, by linear interpolation: the
// first x if the curve starts below the level, the last x if it ends above. Where the curve equals the level
// over several x (within 1e-12 of it), this is the middle between the first and the last of them: another
// choice would be wrong for the mirrored curve.
double crossing(const std::vector<double>& x, const std::vector<double>& falling, double level);

}  // namespace remote_touch
