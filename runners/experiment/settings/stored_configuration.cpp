#include "runners/experiment/settings/stored_configuration.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "core/parameters/input_error.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

constexpr const char* kProxies = "proxy tracked-sheet averaged-proxy density-proxy oracle-proxy";
constexpr const char* kViewed = "surfels averaged-proxy";

// A setting of schema /2.
struct RenamedName {
  const char* old_name;
  const char* new_name;
  const char* owners;  // the entries of the catalog that have the setting, separated by blanks
};
constexpr RenamedName kRenamed[] = {
    {"contact_rule", "contact_motion", kProxies},
    {"per_frame", "surface", "press"},
    {"sheet_spacing_m", "layer_spacing_m", "moving-shape"},
    {"sheets", "layers", "moving-shape"},
    {"true_motion", "truth", "plates"},
    {"view", "view_direction", kViewed},
};

// A value of a setting, or the name of an entry of the catalog.
struct RenamedValue {
  const char* setting;    // present name; of an entry: "scenario.name" or "trajectory.name"
  const char* old_value;  // a text, or the JSON of another value
  const char* new_value;
  const char* owners;  // as in RenamedName
};
constexpr RenamedValue kRenamedValues[] = {
    {"contact_motion", "tangent_plane", "tangent-plane", kProxies},
    {"exit_rule", "out_of_contact", "out-of-contact", kProxies},
    {"exit_rule", "towards_hip", "towards-hip", kProxies},
    {"force_gate", "contact_now", "contact-now", kProxies},
    {"force_gate", "latest_contact", "latest-contact", kProxies},
    {"free_root", "smallest_magnitude", "smallest-magnitude", kProxies},
    {"images", "by_name", "by-name", "recording"},
    {"playback", "ping_pong", "ping-pong", "recording"},
    {"scenario.name", "sheet", "panel", "sheet"},
    {"surface", "false", "moving", "press"},
    {"surface", "true", "newest-frame", "press"},
    {"trajectory.name", "random-walk", "random-motion", "random-walk"},
    {"truth", "false", "newest-frame", "plates"},
    {"truth", "newest_frame", "newest-frame", "moving-lift moving-shape"},
    {"truth", "true", "moving", "plates"},
};

// True if the entry is one of the names in the text.
bool is_owner(std::string_view owners, const std::string& entry) {
  while (!owners.empty()) {
    const std::size_t end = std::min(owners.find(' '), owners.size());
    if (owners.substr(0, end) == entry) return true;
    owners.remove_prefix(std::min(end + 1, owners.size()));
  }
  return false;
}

// Returns the present name of a setting of that entry.
std::string stored_name(const std::string& entry, const std::string& name) {
  for (const RenamedName& renamed : kRenamed)
    if (name == renamed.old_name && is_owner(renamed.owners, entry)) return renamed.new_name;
  return name;
}

// Returns the present value of a setting of that entry; nothing if it has not changed. setting: the present
// name.
std::optional<std::string> stored_value(const std::string& entry, const std::string& setting,
                                        const std::string& value) {
  for (const RenamedValue& renamed : kRenamedValues)
    if (setting == renamed.setting && value == renamed.old_value && is_owner(renamed.owners, entry))
      return renamed.new_value;
  return {};
}

}  // namespace

std::optional<std::string> renamed_entry(const std::string& section, const std::string& name) {
  return stored_value(name, section + ".name", name);
}

namespace {

constexpr double kUsualRate_hz = 30;

struct Count {
  const char* frames;
  const char* time;
};
constexpr Count kCounts[] = {{"wait_frames", "wait_s"},
                             {"rise_frames", "rise_s"},
                             {"acceleration_frames", "acceleration_s"},
                             {"vanish_at_frame", "vanish_at_s"},
                             {"empty_frame", "empty_frame_at_s"}};

bool is_moving_scene(const Json& value) {
  if (!value.is_object()) return false;
  const auto name = value.find("name");
  return name != value.end() && (*name == "moving-lift" || *name == "moving-shape");
}

double number_or(const Json& scenario, const char* name, double otherwise) {
  const auto found = scenario.find(name);
  return found != scenario.end() && found->is_number() ? found->get<double>() : otherwise;
}

// Returns null if the key is not a count, or its value not a number. A count of -1 means never.
const Count* count_of(const std::string& key, const Json& value) {
  const auto found =
      std::find_if(std::begin(kCounts), std::end(kCounts), [&](const Count& c) { return key == c.frames; });
  return found != std::end(kCounts) && value.is_number() ? found : nullptr;
}

// Keeps the order of the keys, because configurations are also compared as texts.
Json in_seconds(const Json& scenario) {
  const double rate_hz = number_or(scenario, "frame_rate_hz", kUsualRate_hz);
  Json converted = Json::object();
  bool has_counts = false;
  for (const auto& [key, value] : scenario.items()) {
    const Count* const count = count_of(key, value);
    has_counts |= count != nullptr;
    if (count)
      converted[count->time] = value.get<double>() < 0 ? -1.0 : value.get<double>() / rate_hz;
    else
      converted[key] = value;
  }
  // Older versions updated the motion at each frame, and made it linear between frames. These settings keep
  // that, because other updates would give other bits.
  const bool accelerates = number_or(scenario, "acceleration_m_per_s2", 0) != 0;
  const bool moves = accelerates || number_or(scenario, "start_velocity_m_per_s", 0) != 0;
  if (has_counts && moves && rate_hz != kUsualRate_hz) converted["update_rate_hz"] = rate_hz;
  if (has_counts && accelerates && scenario.value("truth", Json()) == "moving")
    converted["between_updates"] = "line";
  return converted;
}

void convert_to_seconds(Json& value) {
  if (!value.is_structured()) return;
  for (Json& part : value) convert_to_seconds(part);
  if (is_moving_scene(value)) value = in_seconds(value);
}

// --- names of schema /2 ---

std::string name_of(const Json& entry) {
  if (!entry.is_object()) return {};
  const auto name = entry.find("name");
  return name != entry.end() && name->is_string() ? name->get<std::string>() : std::string();
}

// setting: its present name, which is not "name".
Json present_value(const std::string& entry, const std::string& setting, const Json& value) {
  if (value.is_structured()) return value;
  const auto renamed =
      stored_value(entry, setting, value.is_string() ? value.get<std::string>() : value.dump());
  return renamed ? Json(*renamed) : value;
}

// Keeps the order of the keys. section: the key of the entry, such as "scenario".
Json with_present_names(const std::string& section, const Json& entry) {
  const std::string name = name_of(entry);
  Json renamed = Json::object();
  for (const auto& [key, value] : entry.items()) {
    const std::string setting = stored_name(name, key);
    renamed[setting] = present_value(name, setting, value);
  }
  renamed["name"] = renamed_entry(section, name).value_or(name);
  return renamed;
}

Json present_axis_value(const std::string& section, const std::string& entry, const std::string& setting,
                        const Json& value) {
  if (setting != "name" || !value.is_string()) return present_value(entry, setting, value);
  const std::string name = value.get<std::string>();
  return renamed_entry(section, name).value_or(name);
}

// Renames the setting of an axis such as renderer.contact_rule, and its values. experiment: that of the
// sweep, with the names of schema /2. The values of an axis over a whole section are entries.
void rename_axis(const Json& experiment, Json& axis) {
  if (!axis.is_object() || !axis.contains("parameter") || !axis["parameter"].is_string()) return;
  const std::string path = axis["parameter"].get<std::string>();
  const std::size_t dot = std::min(path.find('.'), path.size());
  const std::string section = path.substr(0, dot);
  const auto values = axis.find("values");
  const bool is_list = values != axis.end() && values->is_array();
  if (dot == path.size()) {
    if (!is_list) return;
    for (Json& value : *values)
      if (!name_of(value).empty()) value = with_present_names(section, value);
    return;
  }
  const auto owner = experiment.find(section);
  if (owner == experiment.end()) return;
  const std::string entry = name_of(*owner);
  const std::size_t end = std::min(path.find('.', dot + 1), path.size());
  const std::string setting = stored_name(entry, path.substr(dot + 1, end - dot - 1));
  if (is_list)
    for (Json& value : *values) value = present_axis_value(section, entry, setting, value);
  axis["parameter"] = path.substr(0, dot + 1) + setting + path.substr(end);
}

void rename_axes(Json& sweep) {
  if (!sweep.is_object() || !sweep.contains("experiment") || !sweep.contains("axes")) return;
  if (!sweep["experiment"].is_object() || !sweep["axes"].is_array()) return;
  for (Json& axis : sweep["axes"]) rename_axis(sweep["experiment"], axis);
}

// key: that of the value in its object; empty for an element of a list. An entry on an axis is visited twice;
// the second time changes nothing, because no present name is an old one of the same entry.
void use_present_names(const std::string& key, Json& value) {
  if (!value.is_structured()) return;
  rename_axes(value);
  if (value.is_array())
    for (Json& part : value) use_present_names("", part);
  else
    for (auto part = value.begin(); part != value.end(); ++part) use_present_names(part.key(), part.value());
  if (!name_of(value).empty()) value = with_present_names(key, value);
}

// Returns null for a text that is not JSON.
Json configuration_in(const std::string& text) {
  try {
    return parse_json(text, "config");
  } catch (const InputError&) {
    return {};
  }
}

Json translated(Json configuration) {
  convert_to_seconds(configuration);
  use_present_names("", configuration);
  return configuration;
}

// --- what was translated ---

// Returns the key, in the translated object, of a key in `before`.
std::string translated_key(const std::string& key, const Json& before) {
  const Count* const count = is_moving_scene(before) ? count_of(key, before.at(key)) : nullptr;
  return count ? count->time : stored_name(name_of(before), key);
}

// Adds the keys and texts of `before` that differ in `now`. A flag that became a text also has a new key, so
// the key lists it.
void add_translated(const Json& before, const Json& now, std::set<std::string>& names) {
  if (before.is_object() && now.is_object()) {
    for (const auto& item : before.items()) {
      const std::string key = translated_key(item.key(), before);
      if (key != item.key()) names.insert(item.key() + " to " + key);
      add_translated(item.value(), now.at(key), names);
    }
  } else if (before.is_array() && now.is_array()) {
    for (std::size_t i = 0; i < std::min(before.size(), now.size()); ++i)
      add_translated(before[i], now[i], names);
  } else if (before.is_string() && now.is_string() && before != now) {
    names.insert(before.get<std::string>() + " to " + now.get<std::string>());
  }
}

}  // namespace

std::string stored_configuration(const std::string& text) {
  const Json before = configuration_in(text);
  const Json now = translated(before);
  return now == before ? text : now.dump();
}

std::vector<std::string> translated_names(const std::string& text) {
  const Json before = configuration_in(text);
  std::set<std::string> names;
  add_translated(before, translated(before), names);
  return {names.begin(), names.end()};
}

TextAttributes present_attributes(TextAttributes attributes) {
  const std::string schema = attribute(attributes, "schema");
  if (!is_earlier_schema(schema)) return attributes;
  for (auto& [name, value] : attributes) {
    if (name == "schema") value = present_schema(schema);
    if (name == "config") value = stored_configuration(value);
  }
  attributes.emplace_back(kTranslatedFrom, schema);
  return attributes;
}

}  // namespace remote_touch
