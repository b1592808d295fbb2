#include "runners/settings/embedded_data.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/parameters/input_error.h"

namespace remote_touch {

std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind) {
  for (const EmbeddedText& text : stored)
    if (name_or_file == text.name) return text.json;
  std::ifstream in(name_or_file, std::ios::binary);
  std::error_code unreachable;
  if (!in || std::filesystem::is_directory(name_or_file, unreachable))
    throw InputError(name_or_file,
                     "cannot be read: expected " + kind + " name (see remote-touch list) or a JSON file");
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace remote_touch
