#include "runners/sweep/sweep.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/configuration.h"

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

namespace {

constexpr double kMaxValue = 1e12;

enum class Scale { linear, log };

struct RangeAxis {
  std::string parameter;
  double from = 0, to = 0;
  int count = 0;
  Scale scale = Scale::linear;
};

Parameters parameters(RangeAxis& axis) {
  return {
      {"parameter", &axis.parameter, 0, 0, "path of the parameter, for example scenario.noise_sigma_m"},
      {"from", &axis.from, -kMaxValue, kMaxValue, "first value"},
      {"to", &axis.to, -kMaxValue, kMaxValue, "last value"},
      {"count", &axis.count, 1, kMaxAxisValues, "number of values"},
      {"scale", choice(axis.scale, {"linear", "log"}), 0, 0, "equal steps or equal ratios"},
  };
}

// Rounds to 12 significant digits: the last bits of the C library's logarithm differ between machines.
double rounded(double value) {
  return std::strtod(formatted("%.11e", value).c_str(), nullptr);
}

Json value_of(const RangeAxis& axis, std::size_t i, std::size_t count) {
  const double last = static_cast<double>(count - 1), place = static_cast<double>(i);
  double value = axis.from;
  if (i == count - 1 && count > 1)
    value = axis.to;
  else if (i > 0)
    value = axis.scale == Scale::linear
                ? (axis.from * (last - place) + axis.to * place) / last
                : rounded(std::exp(std::log(axis.from) + std::log(axis.to / axis.from) * (place / last)));
  // An integer is returned as such, because the parameter may accept nothing else.
  if (value == std::floor(value) && value >= 0) return static_cast<std::uint64_t>(value);
  return value;
}

// Returns the axis of one parameter with these values. Its name is the last part of the path.
SweepAxis axis_of(const std::string& parameter, const std::vector<Json>& values, const std::string& label) {
  const std::string name = parameter.substr(parameter.rfind('.') + 1);
  if (name.empty())
    throw InputError(label + ".parameter = \"" + parameter + "\"", "expected the path of a parameter");
  SweepAxis axis;
  axis.coordinate = coordinate_of(name, unit_of_path(parameter), parameter, values, label + ".values");
  for (const Json& value : values) axis.settings.push_back({{parameter, value}});
  return axis;
}

SweepAxis range_axis(const Json& json, const std::string& label, int levels) {
  RangeAxis axis;
  for (const char* needed : {"from", "to", "count"})
    if (!json.contains(needed))
      throw InputError(label, std::string(needed) + " is missing: expected from, to and count, or values");
  read_parameters(json, parameters(axis), label);
  if (axis.count > 1 && axis.from == axis.to)
    throw InputError(label + ".to = " + Json(axis.to).dump(), "expected a value different from \"from\"");
  if (axis.scale == Scale::log && !(axis.from > 0 && axis.to > 0))
    throw InputError(label + ".scale = \"log\"", "expected \"from\" and \"to\" above 0");
  const std::size_t stride = std::size_t{1} << levels;
  const std::size_t count = static_cast<std::size_t>(axis.count - 1) * stride + 1;
  if (count > kMaxAxisValues)
    throw InputError(label + ".count",
                     "more than " + std::to_string(kMaxAxisValues) + " values after refinement");
  std::vector<Json> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(value_of(axis, i, count));
    if (i > 0 && values[i] == values[i - 1])
      throw InputError(label + ".count = " + std::to_string(axis.count),
                       "neighbouring values are equal: expected fewer between from and to");
  }
  SweepAxis result = axis_of(axis.parameter, values, label);
  result.stride = stride;
  Json definition = Json::object();
  write_parameters(parameters(axis), definition);
  result.definition = definition.dump();
  return result;
}

SweepAxis list_axis(const Json& json, const std::string& label) {
  std::string parameter;
  Json rest = json;
  rest.erase("values");
  const Parameters known = {{"parameter", &parameter, 0, 0, "path of the parameter"}};
  read_parameters(rest, known, label);
  const Json& values = json["values"];
  if (!values.is_array() || values.empty() || values.size() > kMaxAxisValues)
    throw InputError(label + ".values",
                     "expected a list of 1 to " + std::to_string(kMaxAxisValues) + " values");
  SweepAxis result = axis_of(parameter, std::vector<Json>(values.begin(), values.end()), label);
  result.definition = Json({{"parameter", parameter}, {"values", values}}).dump();
  return result;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// A result stores numbers as doubles. An integer beyond 2^53, as a seed may be, is stored by its name.
bool is_double(const Json& value) {
  constexpr double kMaxInteger = 9007199254740992;
  return value.is_number() && (value.is_number_float() || std::abs(value.get<double>()) < kMaxInteger);
}

// A result states names, or numbers: 1 and 1.0 are one value.
void refuse_repeated(const std::vector<Json>& values, const std::string& label) {
  std::set<std::string> names;
  std::set<double> numbers;
  for (const Json& value : values) {
    const std::string name = text_of(value);
    if (name.empty()) throw InputError(label, value.dump() + " is empty: expected names");
    if (!names.insert(name).second || (is_double(value) && !numbers.insert(value.get<double>()).second))
      throw InputError(label, value.dump() + " appears twice: expected once");
  }
}

// Returns the name of a column of Rows, which has a unit of its own: "ry_deg" for "trajectory.poses.2.4".
// Empty if the path does not lead to one.
std::string column_of_rows(const std::vector<std::string>& keys) {
  const std::size_t n = keys.size();
  if (n < 4 || !is_index(keys[n - 2]) || !is_index(keys[n - 1]) || keys[n - 1].size() > 2) return {};
  const auto place = std::stoul(keys[n - 1]);
  for (const ExperimentSection& section : experiment_sections()) {
    if (section.key != keys[0]) continue;
    for (const SectionEntry& entry : section.entries()) {
      const auto owner = entry.make();
      for (const Parameter& p : owner->settings())
        if (const auto* rows = std::get_if<Rows>(&p.value); p.name == keys[n - 3] && rows)
          return place < rows->columns.size() ? rows->columns[place] : "";
    }
  }
  return {};
}

}  // namespace

std::string unit_of_path(const std::string& path) {
  const std::vector<std::string> keys = path_keys(path);
  std::string named = column_of_rows(keys);
  if (named.empty()) named = is_index(keys.back()) && keys.size() > 1 ? keys[keys.size() - 2] : keys.back();
  const Unit* const unit = unit_of(named);
  return unit ? unit->text : "1";
}

Column coordinate_of(const std::string& name, const std::string& unit, const std::string& long_name,
                     const std::vector<Json>& values, const std::string& label) {
  refuse_repeated(values, label);
  Column column{name, unit, long_name, {}, 1, {}};
  if (std::all_of(values.begin(), values.end(), is_double)) {
    std::vector<double> numbers;
    for (const Json& value : values) numbers.push_back(value.get<double>());
    column.values = numbers;
    return column;
  }
  std::vector<std::int32_t> places;
  for (const Json& value : values) {
    places.push_back(static_cast<std::int32_t>(places.size()));
    column.value_names.push_back(text_of(value));
  }
  column.values = places;
  return column;
}

std::vector<std::string> SweepAxis::paths() const {
  std::vector<std::string> all;
  std::set<std::string> seen;
  for (const std::vector<ChangedSetting>& row : settings)
    for (const ChangedSetting& setting : row)
      if (seen.insert(setting.first).second) all.push_back(setting.first);
  return all;
}

ChangedSetting SweepAxis::stated(std::size_t i) const {
  if (!is_joint) return settings[i].front();
  if (const auto* numbers = std::get_if<std::vector<double>>(&coordinate.values))
    return {coordinate.name, (*numbers)[i]};
  return {coordinate.name, coordinate.value_names[i]};
}

namespace {

SweepAxis read_any_axis(const Json& json, const std::string& label, int levels) {
  if (is_joint(json)) return read_joint_axis(json, label);
  if (!json.is_object() || !json.contains("parameter"))
    throw InputError(
        label,
        "expected {\"parameter\": ..., \"from\": ..., \"to\": ..., \"count\": ...}, or an axis with \"values\", "
        "\"parameters\" or \"variants\"");
  return json.contains("values") ? list_axis(json, label) : range_axis(json, label, levels);
}

}  // namespace

SweepAxis read_axis(const Json& json, const std::string& label, int levels) {
  Json rest = json;
  std::optional<bool> common_noise;
  if (json.is_object() && json.contains("common_noise")) {
    if (!json["common_noise"].is_boolean())
      throw InputError(label + ".common_noise = " + shown(json["common_noise"]), "expected true or false");
    common_noise = json["common_noise"].get<bool>();
    rest.erase("common_noise");
  }
  SweepAxis axis = read_any_axis(rest, label, levels);
  if (!common_noise) return axis;
  axis.common_noise = *common_noise;
  Json definition = parse_json(axis.definition, label);
  definition["common_noise"] = *common_noise;
  axis.definition = definition.dump();
  return axis;
}

Json thinned_axis(Json definition, std::size_t every, bool is_refined) {
  if (definition.contains("count") && every > 1) {
    Json range = definition;
    range.erase("common_noise");
    RangeAxis axis;
    read_parameters(range, parameters(axis), "axis");
    const auto count = static_cast<std::size_t>(axis.count);
    Json values = Json::array();
    for (std::size_t i = 0; i < count; i += every) values.push_back(value_of(axis, i, count));
    if (is_refined) {  // only a range has values between those of the first round
      definition["to"] = values.back(), definition["count"] = values.size();
      return definition;
    }
    Json list = {{"parameter", axis.parameter}, {"values", values}};
    if (definition.contains("common_noise")) list["common_noise"] = definition["common_noise"];
    return list;
  }
  for (const char* const list : {"values", "labels", "variants"}) {
    const auto found = definition.find(list);
    if (found == definition.end()) continue;
    Json kept = Json::array();
    for (std::size_t i = 0; i < found->size(); i += every) kept.push_back((*found)[i]);
    *found = kept;
  }
  return definition;
}

}  // namespace remote_touch
