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
// Renderers with their settings, and scenes, of the scorecard.
std::span<const EmbeddedText> embedded_methods();
std::span<const EmbeddedText> embedded_scenes();
// Numbers of tests/second_implementation, by chapter.
std::span<const EmbeddedText> embedded_second_implementation();

// The text of that name, or of that file. Throws InputError when there is neither. kind: for its message,
// such as "an experiment's".
std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind);

}  // namespace remote_touch
