// How columns are padded: to whole groups of kLanes, which every x86-64 level reads at once or in parts.
#pragma once

#include <cstddef>

namespace remote_touch {

inline constexpr std::size_t kLanes = 8;
inline constexpr double kFarAway = 1e100;  // coordinate of a padding point; its square is still finite

}  // namespace remote_touch
