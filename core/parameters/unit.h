// The unit of a parameter, which ends the parameter's name: "r1_m" is a length in metres.
#pragma once

#include <span>
#include <string>

namespace remote_touch {

// Powers of metre, second and newton.
struct Dimension {
  int length = 0;
  int time = 0;
  int force = 0;
  bool operator==(const Dimension&) const = default;
};

struct Unit {
  const char* ending;  // end of the name: "_m_per_s"
  const char* text;    // unit in results: "m/s"; "1" for a pure number
  Dimension dimension;
};

// All units; a unit stands before each one whose ending also ends its own ("_N_per_m" before "_per_m").
std::span<const Unit> known_units();
// Returns the first known unit that ends the name, or nullptr, as for counts and pure numbers ("rows",
// "gamma").
const Unit* unit_of(const std::string& name);

}  // namespace remote_touch
