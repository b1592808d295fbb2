// A number of an answer with its 95 % interval.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace remote_touch {

// Every interval is two-sided, at 95 %. Every p is two-sided. NaN: there is no such number. A p and an
// interval come from the same test: p <= 0.05 exactly if the interval does not hold 0.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  double p = std::numeric_limits<double>::quiet_NaN();  // null hypothesis: the value is 0
  // The number of independent runs or pairs: runs that share random numbers count as one, a cluster.
  std::int64_t clusters = 0;
  std::int64_t unknown = 0;  // number of runs or pairs whose outcome is unknown (NaN)
  std::string method = {};   // name of the interval; empty: there is none
  std::string note = {};     // why something is missing, and what the reader must know; "; " between reasons
  // True if p <= 0.05, but few large differences decide (estimated_difference()): such an estimate shows
  // neither "better" nor "worse".
  bool is_skewed = false;

  // Adds a reason to the note, once.
  void add_note(const std::string& reason) {
    if (note.find(reason) == std::string::npos) note += (note.empty() ? "" : "; ") + reason;
  }
};

// The fewest pairs or clusters with which a test can reach p = 0.05: 2 / 2^6 = 0.03.
inline constexpr std::int64_t kLeastPairs = 6;
// The note of an estimate whose is_skewed is true.
inline constexpr const char* kSkewedNote = "skewed: few large differences decide";
// The method of an estimate from runs without random numbers. Its value is exact, and it has an interval only
// if outcomes are unknown or if it lies between two values of an axis.
inline constexpr const char* kExactMethod = "exact";

}  // namespace remote_touch
