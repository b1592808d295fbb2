#pragma once

#include <limits>

namespace remote_touch {

// What a measure gives where a run has nothing to measure. Not 0 / 0, whose sign is the machine's choice.
inline constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

}  // namespace remote_touch
