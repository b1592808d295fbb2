#include "core/noise.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

// radius^2 = -2 ln((word + 1) 2^-32), see kernels/noise.cpp
std::uint32_t largest_word(double radius) {
  constexpr double kWords = 4294967296.0;
  if (!(radius > 0)) return 0xFFFFFFFFu;
  const double words = kWords * std::exp(-0.5 * radius * radius) * (1 + 1e-6) + 1;
  return static_cast<std::uint32_t>(std::min(words, kWords - 1));
}

}  // namespace remote_touch
