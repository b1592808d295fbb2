// Padding of columns to whole groups of kLanes. Each x86-64 level reads a group in one or several vectors.
#pragma once

#include <cstddef>

namespace remote_touch {

inline constexpr std::size_t kLanes = 8;
inline constexpr double kFarAway = 1e100;  // coordinate of a padding point; its square is still finite

}  // namespace remote_touch
