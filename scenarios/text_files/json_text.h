// Reads JSON of unknown origin safely.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace remote_touch {

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
