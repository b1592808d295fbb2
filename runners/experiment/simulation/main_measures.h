// The few measures that answer what a user asks first about a run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/measures/measures.h"

namespace remote_touch {

// The fixtures of an experiment decide which measures matter: a region keeps the proxy away from the surface.
enum class Fixtures { none, some };

struct MeasuredValue {
  const Measure* measure = nullptr;
  double value = 0;
};
// Returns the measures of a list that apply to the trace, with their values, in the order of the list. The
// pointers are valid as long as the list.
std::vector<MeasuredValue> measured_values(std::span<const Measure> list, const Trace& trace);
// Returns at most five built-in measures from `all`, those that matter most and have a value, and then all
// measures that are not built in, because their author wants to see them.
std::vector<MeasuredValue> main_measures(const std::vector<MeasuredValue>& all, Fixtures fixtures);

// Returns "metres" for "m". Empty for pure numbers ("1"); an unknown unit is returned as it is.
std::string unit_in_words(const std::string& unit);

}  // namespace remote_touch
