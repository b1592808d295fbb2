// The JSON files of data/, compiled into the program.
#pragma once

#include <span>
#include <string>

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

}  // namespace remote_touch
