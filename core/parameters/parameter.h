// Parameters as data: a configuration struct lists its fields once, in a function `parameters(Struct&)`, and
// reading, range checks, help and the configuration stored with a result all use that list. A function
// `validate(const Struct&)` describes the first invalid combination in one line; empty if there is none.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// One of a few named values. The owner stores it in an enumeration.
struct Choice {
  std::vector<std::string> names;
  std::function<int()> get;
  std::function<void(int)> set;
};

// A list of equally long rows of numbers, for example waypoints.
struct Rows {
  std::vector<std::string> columns;
  std::vector<double>* values;  // row after row
};

struct Parameter {
  std::string name;  // name in a file, with the unit as suffix
  std::variant<double*, int*, std::uint64_t*, bool*, std::string*, Vec3*, Choice, Rows> value;
  double low = 0;  // allowed range of a number, ends included
  double high = 0;
  std::string help;      // one line; names the equation when there is one
  bool is_live = false;  // may change during a run
};

using Parameters = std::vector<Parameter>;

inline constexpr bool kLive = true;

// Returns the parameters of a list that may change during a run.
inline Parameters live_ones(Parameters list) {
  std::erase_if(list, [](const Parameter& parameter) { return !parameter.is_live; });
  return list;
}

inline Parameters appended(Parameters list, const Parameters& more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

// Returns the parameters of a list except those of these names.
inline Parameters without(Parameters list, const std::vector<std::string>& names) {
  std::erase_if(list, [&](const Parameter& parameter) {
    return std::find(names.begin(), names.end(), parameter.name) != names.end();
  });
  return list;
}

// Returns the Choice for an enumeration whose values are 0, 1, 2, ... in the order of names.
template <class Enumeration>
Choice choice(Enumeration& value, std::vector<std::string> names) {
  return {std::move(names), [&value] { return static_cast<int>(value); },
          [&value](int i) { value = static_cast<Enumeration>(i); }};
}

}  // namespace remote_touch
