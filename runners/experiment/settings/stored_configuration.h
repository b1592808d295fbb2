// The configurations of results that older versions stored, and names that have changed since.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Names of earlier versions that have changed: for hints about old files and scripts, and to read old
// results.

// A parameter of an experiment or a sweep, a measure, or a column of a trace.
struct RenamedName {
  const char* old_name;
  const char* new_name;
  // Entries of the catalog, separated by blanks, whose settings have the old name in results of schema /2.
  // Empty for names of version 0.1, whose results are not read.
  const char* owners = "";
};

// A value of a setting, or the name of an entry of the catalog.
struct RenamedValue {
  const char* setting;    // present name; of an entry: "scenario.name" or "trajectory.name"
  const char* old_value;  // a text, or the JSON of another value
  const char* new_value;
  const char* owners;  // as in RenamedName
};

// Sorted by the old name; some old names have different new names in different sections.
std::span<const RenamedName> renamed_names();
// Sorted by setting and old value.
std::span<const RenamedValue> renamed_values();

// Returns the new name of old_name if it is one of the known names; nothing otherwise. entry: whose setting
// it is, empty in a section without entries; nothing if that is not known. Another entry never had the old
// name.
std::optional<std::string> new_name(const std::string& old_name, const std::vector<std::string>& known,
                                    const std::optional<std::string>& entry = {});
// Returns the new value for an old value of the setting if it is one of the known values; nothing otherwise.
// entry: as of new_name().
std::optional<std::string> new_value(const std::string& setting, const std::string& old_value,
                                     const std::vector<std::string>& known,
                                     const std::optional<std::string>& entry = {});

// Returns the present name of the scenario or trajectory that had this name in results of schema /2; nothing
// for other names. No new entry may have such a name, because results would be read as those of the other.
// section: "scenario", "trajectory" or another.
std::optional<std::string> renamed_entry(const std::string& section, const std::string& name);

// Returns the present name of a setting of that entry in a result of schema /2.
std::string stored_name(const std::string& entry, const std::string& name);
// Returns the present value of a setting of that entry in a result of schema /2; nothing if it has not
// changed. setting: the present name.
std::optional<std::string> stored_value(const std::string& entry, const std::string& setting,
                                        const std::string& value);

// The configurations of results that older versions stored, for this version.

// Returns the same configuration with the parameters of this version. Before version 0.3 the motion of
// moving-lift and moving-shape was given in frames (rise_frames and others). Such a count becomes a time at
// the configuration's frame rate, and the motion keeps its bits. Settings and values that schema /2 had under
// other names (renamed_names()) have their present names, also on axes. Any other text is returned as it is.
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
