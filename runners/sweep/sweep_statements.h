// Checks that a result states what was run: no part of a sweep may overwrite what another part states, and
// every run must have the values of its cell.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/sweep/sweep_axis.h"

namespace remote_touch {

// Throws InputError, with both paths, if two axes set one parameter, or if a parameter of one contains that
// of another.
void refuse_overlapping(const std::vector<SweepAxis>& axes, const std::string& label);

// Throws InputError, with both paths, if a later statement replaces a value of `set` or of --set. The order
// of the statements is: --set of the sweep's own experiment, `set`, --set, the axes. A --set may replace a
// value of `set`, and an earlier --set, but not the object or list around it. A statement also replaces an
// object if it sets a member that the object has. The elements of a list may be axes, because a list cannot
// be given without them. overrides: all "key=value" of the command line. of_experiment: those that do not
// begin with a key of the sweep. json: the sweep with the other overrides applied.
void refuse_overwritten(const Json& json, const std::vector<std::string>& overrides,
                        const std::vector<std::string>& of_experiment, const std::vector<SweepAxis>& axes,
                        const std::string& label);

// Throws InputError unless the run has the value of an axis in its first tick. If the value is an object, the
// run must have all its members. Null means absent or empty.
void require_run(const Experiment& run, const std::string& axis, const Json& value);

}  // namespace remote_touch
