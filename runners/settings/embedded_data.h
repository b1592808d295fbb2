// What comes with the program: the JSON files of data/, compiled in.
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

// The text of that name, or of that file. kind: "an experiment's", for the InputError when there is neither.
std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind);

}  // namespace remote_touch
