#include "runners/experiment/settings/embedded_data.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "scenarios/files/text_file.h"

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

namespace {

nlohmann::json table_named(const std::string& name) {
  for (const EmbeddedText& table : embedded_second_implementation())
    if (name == table.name) return nlohmann::json::parse(table.json);
  throw InputError(name, "no table of this name: expected one of data/second_implementation");
}

}  // namespace

double second_number(const std::string& table, const std::string& place) {
  return table_named(table).at(nlohmann::json::json_pointer(place)).get<double>();
}

std::vector<double> second_column(const std::string& table, const std::string& list,
                                  const std::string& column) {
  const nlohmann::json all = table_named(table);  // outlives the loop over its rows
  std::vector<double> values;
  for (const auto& row : all.at(nlohmann::json::json_pointer(list)))
    values.push_back(row.at(column).get<double>());
  return values;
}

}  // namespace remote_touch
