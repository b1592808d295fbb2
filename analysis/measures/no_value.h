#pragma once

#include <limits>

namespace remote_touch {

// Value of a measure if a run has nothing to measure. It is not computed as 0 / 0, because the sign of that
// NaN depends on the machine.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

}  // namespace remote_touch
