// The configurations of results of schema /2: baselines have it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Returns the present name of the scenario or trajectory that had this name in results of schema /2; nothing
// for other names. No new entry may have such a name, because results would be read as those of the other.
// section: "scenario", "trajectory" or another.
std::optional<std::string> renamed_entry(const std::string& section, const std::string& name);

// Returns the same configuration with the parameters of this version. Before version 0.3 the motion of
// moving-lift and moving-shape was given in frames (rise_frames and others). Such a count becomes a time at
// the configuration's frame rate, and the motion keeps its bits. Settings and values that schema /2 had under
// other names have their present names, also on axes. Any other text is returned as it is.
std::string stored_configuration(const std::string& text);

// Returns the names and text values that stored_configuration() replaces, sorted, each once, as "old to new":
// "contact_rule to contact_motion". Empty if the text is not JSON.
std::vector<std::string> translated_names(const std::string& text);

// Root attribute of what was made of a result of an earlier schema: that schema. The names in it were
// translated, so the program that its other attributes name cannot read them.
inline constexpr const char* kTranslatedFrom = "translated_from";

// Returns the attributes of a stored result. Those of an earlier schema have the stored_configuration(), the
// present schema, and the attribute translated_from.
TextAttributes present_attributes(TextAttributes attributes);

}  // namespace remote_touch
