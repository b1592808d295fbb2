// Published thresholds of perception, for the measures that are in the same unit. A measure below its
// threshold would probably not be noticed by a hand under the conditions of the source. No person was tested
// here.
//
// relative_ripple has no threshold here: that of a vibration is a force in N which depends on its frequency
// and on the grip (see perceived_measures.h), so that no single ratio was published.
#pragma once

#include <span>
#include <string>

namespace remote_touch {

struct PerceptionThreshold {
  const char* measure;  // name of the measure, see measures.h
  const char* unit;     // unit of the measure and of the threshold
  double value;         // positive
  const char* meaning;  // one line: "THRESHOLD is MEANING"
  const char* source;   // authors, title and year
};

// The thresholds, in the order in which they are shown. A measure has at most one.
std::span<const PerceptionThreshold> perception_thresholds();

// True if the magnitude of the measure is below the threshold. False for NaN.
bool is_below(const PerceptionThreshold& threshold, double value);

}  // namespace remote_touch
