// Settings on top of a configuration: those of --set, of a sweep's `set`, and of a cell.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/text_files/json_text.h"

namespace remote_touch {

// Path and value.
using ChangedSetting = std::pair<std::string, Json>;

// The keys of a path, places in lists without leading zeros: equal keys are the same place.
std::vector<std::string> place_keys(const std::string& path);

// assignments: "key=value", in the order in which they are applied. Throws InputError, with both paths, if
// one is lost because a later one sets an object or a list around it that has another value at that place.
void refuse_discarded(const std::vector<std::string>& assignments);

// A line for each assignment that a later one replaces by another value, as a whole or in part:
// "--set seed=1 is replaced by --set seed=2". Throws InputError for an assignment that cannot be read.
std::vector<std::string> replaced_settings(const std::vector<std::string>& assignments);

// The title with what was changed, "a lift, changed: scenario.noise_sigma_m=0, seed=7": the first changes in
// about 120 characters, and how many more there are. Returns the title as it is if nothing was changed or if
// it is empty; an untitled configuration says nothing that could have become false.
std::string changed_title(const std::string& title, const std::vector<ChangedSetting>& changes);

// The settings of the assignments, each path once with its last value, without those that `before` has
// already. Returns none if one of them sets the title: then the user has named the result.
std::vector<ChangedSetting> changes_of(const Json& before, const std::vector<std::string>& assignments);

// Applies the assignments to a configuration and names them in its title. Throws InputError.
void apply_overrides(Json& configuration, const std::vector<std::string>& assignments);

}  // namespace remote_touch
