#include "runners/experiment/settings/json_parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

namespace remote_touch {

std::string without_subject(const std::string& subject, const std::string& line) {
  const std::string begin = InputError(subject, "").what();
  return line.starts_with(begin) ? line.substr(begin.size()) : line;
}

namespace {

std::string number_text(double value) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out.precision(12);
  out << value;
  return out.str();
}

// Writes all digits of a limit. A limit is a double: that of 64 bits is 2^64, one more than the largest
// integer.
std::string integer_text(double limit) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();
  return std::to_string(limit < 0x1p64 ? static_cast<std::uint64_t>(limit) : kLargest);
}

std::string range_text(const Parameter& p) {
  return number_text(p.low) + " to " + number_text(p.high);
}

std::string names_text(const Choice& choice) {
  std::string text;
  for (const std::string& name : choice.names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// Results can store only UTF-8. A JSON file is UTF-8, or it is refused when it is read, but --set may bring
// other text.
bool is_utf8(const Json& text) {
  const std::string unchanged = text.dump(-1, ' ', false, Json::error_handler_t::ignore);
  return unchanged == text.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// Sets one parameter from one JSON value. Every overload returns false if the value does not fit.
struct Reader {
  const Json& json;
  const Parameter& p;

  bool number(const Json& value, double& out) const {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    if (!std::isfinite(number) || number < p.low || number > p.high) return false;
    out = number;
    return true;
  }
  bool operator()(double* out) const { return number(json, *out); }
  bool operator()(int* out) const {
    double value = 0;
    if (!number(json, value) || value != std::floor(value)) return false;
    *out = static_cast<int>(value);
    return true;
  }
  bool operator()(std::uint64_t* out) const {
    // A positive integer from a text is unsigned; one that was made in memory may be signed.
    if (!json.is_number_integer()) return false;
    if (!json.is_number_unsigned() && json.get<std::int64_t>() < 0) return false;
    *out = json.get<std::uint64_t>();
    return static_cast<double>(*out) >= p.low && static_cast<double>(*out) <= p.high;
  }
  bool operator()(bool* out) const {
    if (!json.is_boolean()) return false;
    *out = json.get<bool>();
    return true;
  }
  bool operator()(std::string* out) const {
    if (!json.is_string() || !is_utf8(json)) return false;
    *out = json.get<std::string>();
    return out->find('\0') == std::string::npos;
  }
  bool operator()(Vec3* out) const {
    if (!json.is_array() || json.size() != 3) return false;
    for (int i = 0; i < 3; ++i)
      if (!number(json[static_cast<std::size_t>(i)], (*out)[i])) return false;
    return true;
  }
  bool operator()(const Choice& choice) const {
    if (!json.is_string()) return false;
    const auto found = std::ranges::find(choice.names, json.get<std::string>());
    if (found == choice.names.end()) return false;
    choice.set(static_cast<int>(found - choice.names.begin()));
    return true;
  }
  bool operator()(const Rows& rows) const {
    if (!json.is_array()) return false;
    std::vector<double> values;
    for (const Json& row : json) {
      if (!row.is_array() || row.size() != rows.columns.size()) return false;
      for (const Json& value : row)
        if (values.push_back(0), !number(value, values.back())) return false;
    }
    *rows.values = values;
    return true;
  }
};

struct Writer {
  Json operator()(const auto* v) const { return *v; }
  Json operator()(const Vec3* v) const { return {v->x(), v->y(), v->z()}; }
  Json operator()(const Choice& choice) const { return choice.names[static_cast<std::size_t>(choice.get())]; }
  Json operator()(const Rows& rows) const {
    Json list = Json::array();
    const std::size_t width = rows.columns.size();
    for (std::size_t i = 0; i + width <= rows.values->size(); i += width)
      list.push_back(Json(std::vector<double>(rows.values->begin() + i, rows.values->begin() + i + width)));
    return list;
  }
};

struct Allowed {
  const Parameter& p;
  std::string operator()(const double*) const { return range_text(p); }
  std::string operator()(const int*) const { return "integers " + range_text(p); }
  std::string operator()(const std::uint64_t*) const {
    return "integers " + integer_text(p.low) + " to " + integer_text(p.high);
  }
  std::string operator()(const bool*) const { return "true, false"; }
  std::string operator()(const std::string*) const { return "UTF-8 text"; }
  std::string operator()(const Vec3*) const { return "three numbers, each " + range_text(p); }
  std::string operator()(const Choice& choice) const { return names_text(choice); }
  std::string operator()(const Rows& rows) const {
    std::string text = "rows [";
    for (const std::string& column : rows.columns) text += (text.back() == '[' ? "" : ", ") + column;
    return text + "], each number " + range_text(p);
  }
};

// Returns the number of edits from a to the most similar beginning of b, so that a forgotten unit costs
// nothing, and the number of edits from a to all of b.
std::pair<std::size_t, std::size_t> edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0u);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t swapped = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, swapped});
    }
  }
  return {*std::ranges::min_element(row), row.back()};
}

std::vector<std::string> all_keys(const Parameters& parameters, const std::vector<std::string>& others) {
  std::vector<std::string> keys;
  for (const Parameter& p : parameters) keys.push_back(p.name);
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

// Returns the known key with the most similar spelling. pre: one is known.
const std::string& nearest_key(const std::string& key, const std::vector<std::string>& known) {
  return *std::ranges::min_element(
      known, [&](const auto& a, const auto& b) { return edit_distance(key, a) < edit_distance(key, b); });
}

// Returns the path of the settings alone: "renderer." of "method mine: renderer.".
std::string without_label(const std::string& prefix) {
  const std::size_t colon = prefix.rfind(": ");
  return colon == std::string::npos ? prefix : prefix.substr(colon + 2);
}

// Returns what a refusal of the value expects.
std::string expected_text(const Parameter& p, const Json& value) {
  const bool lacks_number = std::holds_alternative<double*>(p.value) && !value.is_number();
  return (lacks_number ? "expected a number from " : "expected ") + allowed(p);
}

// JSON does not accept .3 and 3. as numbers, but users type them.
Json number_or_text(const std::string& text) {
  if (!text.starts_with('.') && !text.starts_with("-.") && !text.ends_with('.')) return Json(text);
  double number = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  return error == std::errc() && last == end ? Json(number) : Json(text);
}

// Returns the index in the list that a key states; nothing if it is not an index of the list.
std::optional<std::size_t> index_in(const Json& list, const std::string& key) {
  std::size_t i = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), i);
  if (error != std::errc() || end != key.data() + key.size() || i >= list.size()) return std::nullopt;
  return i;
}

}  // namespace

void refuse_key(const std::string& key, const std::vector<std::string>& known, const std::string& prefix) {
  if (known.empty()) throw InputError(prefix + key, "unknown; no parameters here");
  throw InputError(prefix + key, "unknown; did you mean " + without_label(prefix) + nearest_key(key, known));
}

std::string similar_key(const std::string& key, const std::vector<std::string>& known) {
  if (known.empty()) return {};
  const std::string& nearest = nearest_key(key, known);
  return 3 * edit_distance(key, nearest).second <= std::max(key.size(), nearest.size()) ? nearest : "";
}

std::string allowed(const Parameter& parameter) {
  return std::visit(Allowed{parameter}, parameter.value);
}
std::string value_text(const Parameter& parameter) {
  return std::visit(Writer{}, parameter.value).dump();
}

void read_parameters(const Json& object, const Parameters& parameters, const std::string& path,
                     const std::vector<std::string>& elsewhere) {
  if (!object.is_object()) throw InputError(path, "not an object: expected {\"name\": ..., ...}");
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const auto& item : object.items()) {
    const std::string& key = item.key();
    const Json& value = item.value();
    if (std::ranges::find(elsewhere, key) != elsewhere.end()) continue;
    const auto found = std::ranges::find_if(parameters, [&](const auto& p) { return p.name == key; });
    if (found == parameters.end()) refuse_key(key, all_keys(parameters, elsewhere), prefix);
    if (!std::visit(Reader{value, *found}, found->value))
      throw InputError(prefix + key + " = " + shown(value), expected_text(*found, value));
  }
}

void write_parameters(const Parameters& parameters, Json& object) {
  for (const Parameter& p : parameters) object[p.name] = std::visit(Writer{}, p.value);
}

std::pair<std::string, Json> read_assignment(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("--set " + assignment, "expected key=value, for example renderer.r1_m=0.004");
  const std::string text = assignment.substr(equals + 1);
  if (!is_utf8(assignment)) throw InputError("--set " + assignment, "expected UTF-8");
  std::string path = assignment.substr(0, equals);
  const std::optional<Json> value = json_or_none(text, "--set " + path);
  return {std::move(path), value ? *value : number_or_text(text)};
}

void apply_override(Json& configuration, const std::string& assignment) {
  const auto [path, value] = read_assignment(assignment);
  set_value(configuration, path, value, "--set " + assignment);
}

bool is_index(const std::string& key) {
  return !key.empty() && key.find_first_not_of("0123456789") == std::string::npos;
}

std::vector<std::string> path_keys(const std::string& path) {
  std::vector<std::string> keys;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    keys.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return keys;
}

const Json* find_value(const Json& json, std::span<const std::string> keys) {
  const Json* value = &json;
  for (const std::string& key : keys) {
    if (value->is_array()) {
      const auto index = index_in(*value, key);
      if (!index) return nullptr;
      value = &(*value)[*index];
    } else {
      const auto member = value->find(key);  // end() if the value is no object
      if (member == value->end()) return nullptr;
      value = &*member;
    }
  }
  return value;
}

void set_value(Json& configuration, const std::string& path, const Json& value, const std::string& subject) {
  if (std::ranges::count(path, '.') >= kMaxJsonDepth)
    throw InputError(subject.substr(0, 64) + "...",
                     "expected at most " + std::to_string(kMaxJsonDepth) + " levels");
  Json* place = &configuration;
  for (const std::string& key : path_keys(path)) {
    if (place->is_null()) *place = Json::object();
    if (place->is_array() && !place->empty()) {
      const auto i = index_in(*place, key);
      if (!i)
        throw InputError(subject, "expected an index of the list, 0 to " + std::to_string(place->size() - 1));
      place = &(*place)[*i];
      continue;
    }
    if (!place->is_object())
      throw InputError(subject, "the path continues below a plain value or an empty list");
    place = &(*place)[key];
  }
  *place = value;
}

}  // namespace remote_touch
