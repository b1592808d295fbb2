// The direction in which a measure gets better.
#pragma once

#include <map>
#include <string>

namespace remote_touch {

// not_negative: values of 0 and more are equally good. A smaller gap is no worse, as long as there is a gap.
enum class Better { neither, smaller, larger, near_zero, not_negative };

// The keys are the names of measures. A measure without an entry has no direction.
using Directions = std::map<std::string, Better>;
Better direction_of(const Directions& directions, const std::string& measure);

// True for popped_through and other measures of the outcome of a run. If two runs differ in one of them, no
// other measure decides which is better: a run that lost the surface has no force that could be noisy.
bool is_outcome(const std::string& measure);

// "smaller is better", "has no direction", ...
const char* text_of(Better better);

// Returns a value that is smaller if the measure is better. A measure without a direction keeps its value.
double badness(double value, Better better);

}  // namespace remote_touch
