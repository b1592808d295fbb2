// Parameters as data: a configuration struct lists its fields once, in a function `parameters(Struct&)`, and
// reading, range checks, help and the configuration stored with a result all use that list. A function
// `validate(const Struct&)` describes the first invalid combination in one line; empty if there is none.
//
// Beside them: the units of parameters, a fraction over time (scheduled()), and InputError, the one
// exception for bad input.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "core/points/vector.h"

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

// The unit of a parameter, which ends the parameter's name: "r1_m" is a length in metres.

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

// Returns a fraction at a time, from rows of time in seconds and fraction. It is linear between two rows and
// jumps where two rows have the same time. It is constant before the first row and after the last. It is 1 if
// there are no rows.
double scheduled(const std::vector<double>& rows, double time_s);

// Returns a message about the first row whose fraction is above 1 or whose time is before that of the
// previous row, such as "NAME: time ..."; empty if there is none. what: name of the fraction in that message.
std::string validate_schedule(const std::vector<double>& rows, const std::string& name,
                              const std::string& what);

// The one exception for bad input: a file, a parameter or a flag that cannot be used. The message is a single
// line "subject: what is wrong, what is expected"; the command line prints it and exits with 2.

// Returns the text as one line of UTF-8. A line break or tab becomes a blank. The bytes of other control
// characters (ASCII and U+0080 to U+009F), of the separators U+2028 and U+2029, and those that are not UTF-8
// are written as \x and two hexadecimal digits. The middle of a word longer than 400 bytes, and then of a
// line longer than 1000 bytes, is replaced with "...".
std::string printable(const std::string& text);

class InputError : public std::runtime_error {
 public:
  // subject: the file or the parameter path, as the user would write it.
  InputError(const std::string& subject, const std::string& problem) : InputError(subject + ": " + problem) {}
  // line: subject and problem in one line, as the validate() functions return them.
  explicit InputError(const std::string& line) : std::runtime_error(printable(line)) {}
};

// Returns the text of a format of std::printf with its values.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace remote_touch
