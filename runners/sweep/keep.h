// The key "keep": what a sweep keeps of its runs.
#pragma once

#include <string>
#include <vector>

#include "analysis/measures/measures.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

// runs: the measures of each run. tally: counts, exact sums, extremes and quantiles of each
// cell (analysis/tally). events: a tally, and the numbers of the runs in which an event happened.
enum class Keep { runs, tally, events };

// Reads the key "keep" of a sweep; runs if it is missing. Throws InputError for another value, for a sweep
// with refinement that does not keep its runs, and for "events" in a sweep none of whose measures is an event
// (is_event()). label: names the source in errors.
Keep read_keep(const Json& sweep, const std::vector<Measure>& measures, const std::string& label);
const char* name_of(Keep keep);

}  // namespace remote_touch
