// Allowed deviation of a number from the number of a baseline.
#pragma once

#include <map>
#include <string>

namespace remote_touch {

// The deviation |candidate - baseline| may be at most absolute + relative * |baseline|. If both are zero, the
// numbers must be equal.
struct Tolerance {
  double absolute = 0;
  double relative = 0;
  bool operator==(const Tolerance&) const = default;
};

// Tolerances by name; "*" is for all names that are not listed. Without either, numbers must be equal.
using Tolerances = std::map<std::string, Tolerance>;
Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name);

// Numbers are equal as by == (so 0 and -0 are), and NaN equals NaN. NaN or infinity against any other number
// is outside, whatever the tolerance.
bool within(const Tolerance& tolerance, double baseline, double candidate);

}  // namespace remote_touch
