#include "analysis/measures/better.h"

#include <cmath>

namespace remote_touch {

Better direction_of(const Directions& directions, const std::string& measure) {
  const auto found = directions.find(measure);
  return found == directions.end() ? Better::neither : found->second;
}

bool is_outcome(const std::string& measure) {
  return measure == "popped_through" || measure == "tool_popped_through" || measure == "non_finite_fraction";
}

const char* text_of(Better better) {
  constexpr const char* kTexts[] = {"has no direction", "smaller is better", "larger is better",
                                    "nearer to zero is better",
                                    "larger is better up to 0; all values from 0 on are equally good"};
  return kTexts[static_cast<int>(better)];
}

double badness(double value, Better better) {
  switch (better) {
    case Better::larger:
      return -value;
    case Better::near_zero:
      return std::abs(value);
    case Better::not_negative:
      return value >= 0 ? 0 : -value;  // NaN stays NaN
    case Better::neither:
    case Better::smaller:
      break;
  }
  return value;
}

}  // namespace remote_touch
