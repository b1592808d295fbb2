#include "runners/experiment/settings/second_implementation.h"

#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/settings/embedded_data.h"

namespace remote_touch {

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
