#include "analysis/theory/ball_closing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

std::vector<double> ball_closing(const std::vector<double>& heights, double spacing, double radius) {
  const int count = static_cast<int>(heights.size()), reach = static_cast<int>(radius / spacing);
  std::vector<double> cap;  // half-height of the ball at an offset of k samples
  for (int k = 0; k <= reach; ++k)
    cap.push_back(std::sqrt(std::max(0.0, radius * radius - k * spacing * k * spacing)));

  const auto slide = [&](const std::vector<double>& from, double start, auto&& better, double sign) {
    std::vector<double> to(from.size(), start);
    for (int i = 0; i < count; ++i)
      for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j)
        to[static_cast<std::size_t>(i)] =
            better(to[static_cast<std::size_t>(i)],
                   from[static_cast<std::size_t>(j)] + sign * cap[static_cast<std::size_t>(std::abs(i - j))]);
    return to;
  };
  const double infinite = std::numeric_limits<double>::infinity();
  // Dilation: the lowest centre that keeps the ball off every sample; erosion: the lowest underside of those
  // balls.
  const auto highest = [](double a, double b) { return std::max(a, b); };
  const auto lowest = [](double a, double b) { return std::min(a, b); };
  return slide(slide(heights, -infinite, highest, +1), infinite, lowest, -1);
}

}  // namespace remote_touch
