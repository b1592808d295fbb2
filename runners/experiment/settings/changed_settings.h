// The stored JSON files of data/, settings on top of a configuration, and their differences.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/files/input_files.h"

namespace remote_touch {

struct EmbeddedText {
  const char* name;
  const char* json;
};

std::span<const EmbeddedText> embedded_experiments();
std::span<const EmbeddedText> embedded_sweeps();
// The renderers of the scorecard with their settings, and its scenes.
std::span<const EmbeddedText> embedded_methods();
std::span<const EmbeddedText> embedded_scenes();
// Numbers of tests/second_implementation, by chapter.
std::span<const EmbeddedText> embedded_second_implementation();

// True if one of the texts has this name.
bool is_stored(std::span<const EmbeddedText> stored, const std::string& name);

// Returns the stored text of that name, or the text of that file. Throws InputError if there is neither.
// kind: words for its message, such as "an experiment's".
std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind);

// Numbers that the second implementation (tests/second_implementation) computes from the equations, for
// claims to compare with. Its tables are data/second_implementation/*.json, so no number is copied by hand.

// Returns a number by the name of the table and its path in it: ("chapter_5", "/crossing/max_force_N").
double second_number(const std::string& table, const std::string& place);
// Returns the same column of every row of a list.
std::vector<double> second_column(const std::string& table, const std::string& list,
                                  const std::string& column);

// Settings on top of a configuration: those of --set, of a sweep's `set`, and of a cell.

// Path and value.
using ChangedSetting = std::pair<std::string, Json>;

// Returns at most the first max bytes of the text, and "..." for the rest. Never cuts a UTF-8 character.
std::string first_part(const std::string& text, std::size_t max);

// Returns the keys of a path. Indices in lists have no leading zeros, so that equal keys are the same
// setting.
std::vector<std::string> normalised_keys(const std::string& path);

// assignments: "key=value", in the order in which they are applied. Throws InputError, with both paths, if an
// assignment has no effect: a later one sets an object or a list around it, without the same value there.
void refuse_discarded(const std::vector<std::string>& assignments);

// Returns a line for each assignment that a later one replaces by another value, as a whole or in part:
// "--set seed=1 is replaced by --set seed=2". Throws InputError for an assignment that cannot be read.
std::vector<std::string> replaced_settings(const std::vector<std::string>& assignments);

// Returns the title with the changes, such as "a lift, changed: scenario.noise_sigma_m=0, seed=7": the first
// changes, in about 120 characters, and the number of further ones. Returns the title as it is if nothing was
// changed, or if it is empty: an empty title states nothing that could have become false.
std::string changed_title(const std::string& title, const std::vector<ChangedSetting>& changes);

// Returns the settings that the assignments change: each path once, with its last value, without values that
// `before` has already. Returns none if an assignment sets the title, because the user has then named the
// result.
std::vector<ChangedSetting> changes_of(const Json& before, const std::vector<std::string>& assignments);

// Applies the assignments to a configuration and names them in its title. Throws InputError.
void apply_overrides(Json& configuration, const std::vector<std::string>& assignments);

// Differences between two resolved configurations.

// Returns one text for each difference, such as "renderer.r3_m 0.0075 against 0.007575". Titles are not
// compared, nor are those of the experiments of two sweeps. A long value is shortened, but the first place
// at which it differs is shown. first and second are JSON texts. Throws InputError for a text that is not
// JSON.
std::vector<std::string> configuration_differences(const std::string& first, const std::string& second);

}  // namespace remote_touch
