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

// Tolerances by name; "*" applies to all names that are not listed. A name without either has the tolerance
// 0: its numbers must be equal.
using Tolerances = std::map<std::string, Tolerance>;
Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name);

// Returns true if the deviation is allowed. Numbers that are equal by == are allowed (so 0 and -0 are), and
// so is NaN for NaN. NaN or infinity against any other number is outside, whatever the tolerance.
bool within(const Tolerance& tolerance, double baseline, double candidate);

}  // namespace remote_touch
