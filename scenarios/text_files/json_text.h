// JSON of unknown origin.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace remote_touch {

using Json = nlohmann::ordered_json;

inline constexpr int kMaxJsonDepth = 64;  // deeper values would exhaust the stack when they are printed

// Throws InputError, about the label, for what is no JSON, nests deeper than kMaxJsonDepth, or has a key
// twice in one object.
Json parse_json(const std::string& text, const std::string& label);
// None for what is no JSON; throws as parse_json for the rest.
std::optional<Json> json_or_none(const std::string& text, const std::string& label);

// What is in a file; null where that is absent or no JSON.
Json json_in_file(const std::filesystem::path& file);

// As JSON, for a message: shortened, and safe to print whatever the value holds.
std::string shown(const Json& value);

}  // namespace remote_touch
