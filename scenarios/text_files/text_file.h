// Text files and JSON of unknown origin, read whole, and their refusal.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/parameters/input_error.h"

namespace remote_touch {

// Refuses a file, with what is wrong with it in one line.

// Throws InputError about the subject. The problem is given in parts: texts, and numbers, which are written
// as by std::to_string().
template <class... Parts>
[[noreturn]] void refuse(const std::string& subject, Parts... parts) {
  std::string problem;
  const auto add = [&problem](const auto& part) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(part)>>)
      problem += std::to_string(part);
    else
      problem += part;
  };
  (add(parts), ...);
  throw InputError(subject, problem);
}

// A file of text, such as JSON or a list, read whole.

inline constexpr std::size_t kMaxTextBytes = 16 << 20;

// Reads a file, a pipe or a device, up to kMaxTextBytes. Throws InputError, naming the file and what is
// expected there, if it cannot be read, is longer than that, or a signal interrupts the wait for data.
std::string read_text_file(const std::filesystem::path& file, const std::string& expected);

// Throws InputError if the path leads to something else than a file: a folder, a pipe or a device, also by a
// link. Every input of a run is read twice or more, for its digest and for its content. A pipe can be read
// only once and may never be written to, and a device may never end. A path that leads nowhere is accepted;
// the reader refuses it.
void require_file(const std::filesystem::path& file);
// The same, but accepts a folder.
void require_file_or_folder(const std::filesystem::path& path);

// The same as read_text_file(), but refuses what require_file() refuses.
std::string read_input_text(const std::filesystem::path& file, const std::string& expected);

// Returns the text without a byte order mark, which some editors write in front of UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

// Reads JSON of unknown origin safely.

using Json = nlohmann::ordered_json;

inline constexpr int kMaxJsonDepth = 64;  // deeper values would exhaust the stack when they are printed

// Throws InputError, about the label, for text that is not JSON, nests deeper than kMaxJsonDepth, or has a
// key twice in one object.
Json parse_json(const std::string& text, const std::string& label);
// Returns none for text that is not JSON. Otherwise returns or throws as parse_json().
std::optional<Json> json_or_none(const std::string& text, const std::string& label);

// Returns the content of a file, or null if the file cannot be read or parse_json() would refuse it.
Json json_in_file(const std::filesystem::path& file);

// Returns the value as JSON, for a message: shortened, and always safe to print.
std::string shown(const Json& value);

}  // namespace remote_touch
