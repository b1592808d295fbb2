// The arithmetic mean.
#pragma once

#include <vector>

namespace remote_touch {

// Adds the numbers in the order of the list. Returns NaN for an empty list.
double mean(const std::vector<double>& values);

}  // namespace remote_touch
