#include "runners/sweep/joint_axis.h"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

using Row = std::vector<ChangedSetting>;

// A name of a coordinate in HDF5, in Python and in --cell NAME=VALUE.
void require_identifier(const std::string& name, const std::string& label) {
  const auto may_follow = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0 ||
      !std::all_of(name.begin(), name.end(), may_follow))
    throw InputError(label + ".name = " + shown(name),
                     "expected a letter, then letters, digits and _, for example \"r_c\"");
}

const Json& list_of(const Json& json, const char* key, const std::string& label, const char* expected) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->empty() || found->size() > kMaxAxisValues)
    throw InputError(label + "." + key, std::string("expected ") + expected);
  return *found;
}

// Throws InputError if two paths of the row overlap: the later one would replace the earlier one.
void refuse_overlap_in(const Row& row, const std::string& label) {
  for (std::size_t later = 0; later < row.size(); ++later)
    for (std::size_t i = 0; i < later; ++i) {
      const auto a = normalised_keys(row[i].first), b = normalised_keys(row[later].first);
      if (std::equal(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(std::min(a.size(), b.size())),
                     b.begin()))
        throw InputError(label, row[later].first + " overlaps " + row[i].first +
                                    ": expected each parameter once, and none that contains another");
    }
}

// Throws InputError for a path without a key, or with an empty one.
const std::string& require_path(const std::string& path, const std::string& label) {
  const std::vector<std::string> keys = path_keys(path);
  if (keys.empty() || std::any_of(keys.begin(), keys.end(), [](const auto& key) { return key.empty(); }))
    throw InputError(label, shown(path) + ": expected the path of a parameter");
  return path;
}

std::vector<std::string> read_paths(const Json& json, const std::string& label) {
  std::vector<std::string> paths;
  for (const Json& path : list_of(json, "parameters", label, "a list of paths of parameters")) {
    if (!path.is_string())
      throw InputError(label + ".parameters", shown(path) + ": expected the path of a parameter");
    paths.push_back(require_path(path.get<std::string>(), label + ".parameters"));
  }
  return paths;
}

std::vector<Row> read_rows(const Json& json, const std::vector<std::string>& paths,
                           const std::string& label) {
  const std::string width = std::to_string(paths.size());
  std::vector<Row> rows;
  for (const Json& values :
       list_of(json, "values", label, "a list of rows, each with a value for each of the parameters")) {
    if (!values.is_array() || values.size() != paths.size())
      throw InputError(label + ".values." + std::to_string(rows.size()),
                       shown(values) + ": expected a list of " + width + " values, one for each parameter");
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < paths.size(); ++i) row.emplace_back(paths[i], values[i]);
  }
  refuse_overlap_in(rows.front(), label + ".parameters");
  return rows;
}

// Returns what the coordinate states for each row: the labels or, without them, the values of the first
// parameter.
std::vector<Json> read_coordinate(const Json& json, const std::vector<Row>& rows, const std::string& label) {
  std::vector<Json> coordinate;
  if (!json.contains("labels")) {
    for (const Row& row : rows) coordinate.push_back(row.front().second);
    return coordinate;
  }
  const Json& labels = list_of(json, "labels", label, "a list of numbers or names");
  const auto is_number = [](const Json& value) { return value.is_number(); };
  const auto is_name = [](const Json& value) { return value.is_string(); };
  if (labels.size() != rows.size() || !(std::all_of(labels.begin(), labels.end(), is_number) ||
                                        std::all_of(labels.begin(), labels.end(), is_name)))
    throw InputError(label + ".labels", "expected " + std::to_string(rows.size()) +
                                            " numbers or as many names, one for each row of values");
  coordinate.assign(labels.begin(), labels.end());
  return coordinate;
}

std::string joined_paths(const SweepAxis& axis) {
  return joined(axis.paths(), ", ");
}

SweepAxis parameters_axis(const Json& json, const std::string& label) {
  std::string name, unit;
  read_parameters(json,
                  {{"name", &name, 0, 0, "name of the coordinate, for example r_c"},
                   {"unit", &unit, 0, 0, "unit of the coordinate, for example m; 1: a pure number"}},
                  label, {"parameters", "values", "labels"});
  require_identifier(name, label);
  const std::vector<std::string> paths = read_paths(json, label);
  SweepAxis axis;
  axis.settings = read_rows(json, paths, label);
  const std::string own_unit = unit_of_path(paths.front());
  if (!json.contains("labels") && !unit.empty() && unit != own_unit)
    throw InputError(label + ".unit = " + shown(unit),
                     "expected " + own_unit + ", the unit of " + paths.front() + ", or labels");
  if (unit.empty()) unit = json.contains("labels") ? "1" : own_unit;
  axis.coordinate =
      coordinate_of(name, unit, joined_paths(axis), read_coordinate(json, axis.settings, label),
                    label + (json.contains("labels") ? ".labels" : ".values: the first parameter"));
  Json definition = {
      {"name", name}, {"unit", unit}, {"parameters", json["parameters"]}, {"values", json["values"]}};
  if (json.contains("labels")) definition["labels"] = json["labels"];
  axis.definition = definition.dump();
  return axis;
}

Row read_variant(const Json& json, std::string& name, const std::string& label) {
  read_parameters(json, {{"name", &name, 0, 0, "name of the variant"}}, label, {"set"});
  if (name.empty()) throw InputError(label + ".name", "expected a name");
  Row row;
  const auto set = json.find("set");
  if (set == json.end()) return row;
  if (!set->is_object()) throw InputError(label + ".set", "expected {\"path\": value, ...}");
  for (const auto& item : set->items())
    row.emplace_back(require_path(item.key(), label + ".set"), item.value());
  refuse_overlap_in(row, label + ".set");
  return row;
}

SweepAxis variants_axis(const Json& json, const std::string& label) {
  std::string name;
  read_parameters(json, {{"name", &name, 0, 0, "name of the coordinate, for example variant"}}, label,
                  {"variants"});
  require_identifier(name, label);
  SweepAxis axis;
  axis.common_noise = true;
  std::vector<Json> names;
  for (const Json& variant : list_of(json, "variants", label, "a list of {\"name\": ..., \"set\": {...}}")) {
    std::string own;
    axis.settings.push_back(
        read_variant(variant, own, label + ".variants." + std::to_string(axis.settings.size())));
    names.emplace_back(own);
  }
  axis.coordinate = coordinate_of(name, "1", joined_paths(axis), names, label + ".variants");
  if (axis.coordinate.long_name.empty())
    throw InputError(label + ".variants", "none sets a parameter: expected one in \"set\"");
  axis.definition = Json({{"name", name}, {"variants", json["variants"]}}).dump();
  return axis;
}

}  // namespace

bool is_joint(const Json& json) {
  return json.is_object() && (json.contains("parameters") || json.contains("variants"));
}

SweepAxis read_joint_axis(const Json& json, const std::string& label) {
  SweepAxis axis = json.contains("variants") ? variants_axis(json, label) : parameters_axis(json, label);
  axis.is_joint = true;
  return axis;
}

}  // namespace remote_touch
