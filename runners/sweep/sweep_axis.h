// One axis of a sweep: its coordinate, and the settings of a run for each value of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

struct SweepAxis {
  // The dimension scale: numbers, or an enumeration of names. long_name is the path of the parameter, or the
  // paths of all parameters with ", " between them.
  Column coordinate;
  // The settings of a run for each value: paths, as for --set, and values. These are the values of the first
  // round, and those between them that refinement may add.
  std::vector<std::vector<ChangedSetting>> settings;
  std::size_t stride = 1;     // index step between values of the first round
  bool is_joint = false;      // true: a joint axis ("parameters" or "variants"), see read_joint_axis()
  bool common_noise = false;  // true: runs that differ only on this axis have the same noise
  std::string definition;     // complete JSON, as in a file

  std::size_t length() const { return settings.size(); }
  // Returns the paths that the axis sets, each once, in the order in which they appear.
  std::vector<std::string> paths() const;
  // Returns what messages and titles call the axis: its name if it is joint, else the path.
  const std::string& subject() const { return is_joint ? coordinate.name : coordinate.long_name; }
  // Returns one value as a title states it: the subject, and the value or its name.
  ChangedSetting stated(std::size_t i) const;
};

// Reads an axis in one of three forms. label names the axis in InputErrors.
//   {"parameter": PATH, "from": A, "to": B, "count": N, "scale": "linear" or "log"}: refinement may halve
//   the steps `levels` times
//   {"parameter": PATH, "values": [...]}
//   a joint axis: several parameters together, or variants, see read_joint_axis()
// Each form may have "common_noise": true or false.
SweepAxis read_axis(const Json& json, const std::string& label, int levels);

// Returns the definition of an axis with every every-th value. A range becomes the list of these values, or,
// in a sweep with refinement, the range from the first to the last of them.
Json thinned_axis(Json definition, std::size_t every, bool is_refined);

// Returns the dimension scale of values: numbers if each one can be stored as a number, else an enumeration
// of their texts. Throws InputError, about label, for a value that appears twice or is empty.
Column coordinate_of(const std::string& name, const std::string& unit, const std::string& long_name,
                     const std::vector<Json>& values, const std::string& label);

// Returns the unit of the parameter at the path; "1" for a pure number. A parameter's unit ends its name; the
// columns of a list of rows have units of their own.
std::string unit_of_path(const std::string& path);

inline constexpr int kMaxAxisValues = 100000;

// A joint axis of a sweep: it sets several parameters together, or has named variants.

// True if the definition is that of a joint axis: if it has "parameters" or "variants".
bool is_joint(const Json& json);

// Reads a joint axis in one of two forms. label names the axis in InputErrors.
//   {"name": NAME, "unit": UNIT, "parameters": [PATH, ...], "values": [[...], ...], "labels": [...]}
//   Each row of "values" has a value for each parameter. The coordinate is the list of labels, numbers or
//   names; without labels it is the column of the first parameter. "unit" is by default that parameter's.
//   {"name": NAME, "variants": [{"name": ..., "set": {PATH: VALUE, ...}}, ...]}
//   The coordinate is the names. A variant may set nothing; then its runs have the values of the experiment.
// Variants have common noise unless "common_noise" is false. Throws InputError also if two paths of one row
// or variant overlap.
SweepAxis read_joint_axis(const Json& json, const std::string& label);

}  // namespace remote_touch
