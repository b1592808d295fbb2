// How far a number may be from that of a baseline.
#pragma once

#include <map>
#include <string>

namespace remote_touch {

// At most absolute + relative * |baseline|. Zero and zero: exact.
struct Tolerance {
  double absolute = 0;
  double relative = 0;
  bool operator==(const Tolerance&) const = default;
};

// By name; "*" is for all other names. Exact if neither is there.
using Tolerances = std::map<std::string, Tolerance>;
Tolerance tolerance_of(const Tolerances& tolerances, const std::string& name);

// Numbers are equal as by == (so 0 and -0 are), and NaN equals NaN. NaN or infinity against any other number
// is outside, whatever the tolerance.
bool within(const Tolerance& tolerance, double baseline, double candidate);

}  // namespace remote_touch
