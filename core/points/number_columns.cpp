#include "core/points/number_columns.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace remote_touch {

double quantile_in_place(std::span<double> values, double fraction) {
  assert(!values.empty() && fraction >= 0 && fraction < 1);
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace remote_touch
