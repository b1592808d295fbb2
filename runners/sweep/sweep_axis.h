// One axis of a sweep: a parameter and its values.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/trace/column.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

struct SweepAxis {
  std::string parameter;     // a path, as for --set
  std::vector<Json> values;  // values of the first round, and those between them that refinement may add
  std::size_t stride = 1;    // index step between values of the first round
  std::string definition;    // complete JSON, as in a file

  // The dimension scale: numbers, or an enumeration of the values' texts. Its name is the last part of the
  // path, its unit the one that ends the name of the parameter (or of its column, in a list of rows).
  Column column() const;
  std::string name() const { return parameter.substr(parameter.rfind('.') + 1); }
};

// Reads an axis: {"parameter": PATH, "from": A, "to": B, "count": N, "scale": "linear" or "log"} or
// {"parameter": PATH, "values": [...]}. Refinement may halve the steps of the first form `levels` times.
// label names the axis in InputErrors.
SweepAxis read_axis(const Json& json, const std::string& label, int levels);

}  // namespace remote_touch
