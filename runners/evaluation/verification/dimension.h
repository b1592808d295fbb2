// The dimensions of a renderer's parameters, from the unit that ends their names, so that a scene and a
// renderer can be converted together to other units of length, time and force.
#pragma once

#include <string>

#include "core/parameters/parameter.h"

namespace remote_touch {

// Factors by which every length, time and force is multiplied.
struct UnitChange {
  double length = 1;
  double time = 1;
  double force = 1;

  double factor(const Dimension& dimension) const;  // exact if the changes are powers of two
};

// Returns the dimension of a number with that name. "r1_m" is {1, 0, 0} and "damping_Ns_per_m" is {-1, 1, 1}.
// "gamma" has no underscore and is a pure number. Throws InputError, about that name, for an ending that is
// not in known_units(): a wrong guess would make every check by units worthless.
Dimension dimension_of(const std::string& name);

// Multiplies every number by its factor, each column of Rows by its own. Choices, texts, switches and
// integers are not changed. Throws InputError for a name without a known dimension, an integer that would
// have to change, and a number that leaves its allowed range.
void change_units(const Parameters& parameters, const UnitChange& change);

// Returns the largest magnitude of the parameters that are lengths, m; 0 if no parameter is a length.
double max_length_m(const Parameters& parameters);

}  // namespace remote_touch
