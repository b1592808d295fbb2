// Names of earlier versions that have changed, for hints about old files and scripts.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace remote_touch {

// A parameter of an experiment or a sweep, a measure, or a column of a trace.
struct RenamedName {
  const char* old_name;
  const char* new_name;
};

// Sorted by the old name; some old names have different new names in different sections.
std::span<const RenamedName> renamed_names();

// Returns the new name of old_name if it is one of the known names; nothing otherwise.
std::optional<std::string> new_name(const std::string& old_name, const std::vector<std::string>& known);

}  // namespace remote_touch
