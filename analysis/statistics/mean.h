// The mean of numbers.
#pragma once

#include <vector>

namespace remote_touch {

// The numbers are added in their order. NaN of none.
double mean(const std::vector<double>& values);

}  // namespace remote_touch
