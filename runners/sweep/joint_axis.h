// A joint axis of a sweep: it sets several parameters together, or has named variants.
#pragma once

#include "runners/sweep/sweep_axis.h"

namespace remote_touch {

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
