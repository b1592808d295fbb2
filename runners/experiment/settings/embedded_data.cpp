#include "runners/experiment/settings/embedded_data.h"

#include <algorithm>

#include "scenarios/text_files/text_file.h"

namespace remote_touch {

bool is_stored(std::span<const EmbeddedText> stored, const std::string& name) {
  return std::any_of(stored.begin(), stored.end(),
                     [&](const EmbeddedText& text) { return name == text.name; });
}

std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind) {
  for (const EmbeddedText& text : stored)
    if (name_or_file == text.name) return text.json;
  return read_text_file(name_or_file, "expected " + kind + " name (see remote-touch list) or a JSON file");
}

}  // namespace remote_touch
