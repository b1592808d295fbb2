// Reads the parts of a sweep's JSON text. label names the source in InputErrors.
#pragma once

#include <string>
#include <vector>

#include "analysis/measures/measures.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/sweep/sweep_axis.h"

namespace remote_touch {

// True if the path of the override "key=value" begins with a key of a sweep; it is then not of the
// experiment.
bool is_of_sweep(const std::string& assignment);
// Throws InputError for a key that a sweep does not have.
void refuse_unknown_part(const Json& sweep, const std::string& label);

// Returns the complete experiment, with the settings of "set" and the overrides.
Json read_experiment(const Json& sweep, const std::string& label, const std::vector<std::string>& overrides);
std::vector<SweepAxis> read_axes(const Json& sweep, const std::string& label, int levels);
std::vector<Measure> read_measures(const Json& sweep, const std::string& label);

// Returns a title for a sweep that has none: the title of its experiment, with the axes. That title already
// names the changes of the experiment, so only the changes of the sweep itself are added. Empty if the
// experiment has no title.
std::string title_over(const Json& experiment, const std::vector<ChangedSetting>& changes,
                       const std::vector<SweepAxis>& axes);

}  // namespace remote_touch
