// What a renderer's parameters are measured in, read from the unit that ends their names, so that a scene and
// a renderer can be told in other units of length, time and force together.
#pragma once

#include <string>

#include "core/parameters/parameter.h"

namespace remote_touch {

// Powers of metre, second and newton.
struct Dimension {
  int length = 0;
  int time = 0;
  int force = 0;
  bool operator==(const Dimension&) const = default;
};

// How many times as large every length, time and force becomes.
struct UnitChange {
  double length = 1;
  double time = 1;
  double force = 1;

  double factor(const Dimension& dimension) const;  // exact where the changes are powers of two
};

// Of a number with that name: "r1_m" is {1, 0, 0}, "damping_Ns_per_m" {-1, 1, 1}, "gamma", which has no
// underscore, a pure number. Throws InputError, about that name, when it ends in nothing that the table in
// dimension.cpp knows: a wrong guess would make every check by units worthless.
Dimension dimension_of(const std::string& name);

// Multiplies every number by its factor, columns of Rows each by their own. Choices, texts, switches and
// integers stay. Throws InputError for a name without a known dimension, an integer that would have
// to change, and a number that leaves its allowed range.
void change_units(const Parameters& parameters, const UnitChange& change);

// The largest number among the parameters that is a length, m; 0 without one.
double max_length_m(const Parameters& parameters);

}  // namespace remote_touch
