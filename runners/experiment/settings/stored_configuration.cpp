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

constexpr RenamedName kRenamed[] = {
    {"above", "threshold"},
    {"acceleration_frames", "acceleration_s"},
    {"at_rest_m", "rest_threshold_m"},
    {"bridged_frames", "max_missed_frames"},
    {"camera_m", "camera_position_m"},
    {"camera_turn_deg", "camera_rotation_deg"},
    {"closed_at_s", "close_end_s"},
    {"closing_at_s", "close_start_s"},
    {"closing_steps", "max_exit_steps"},
    {"contact_rule", "contact_motion", kProxies},
    {"device_m", "device_position_m"},
    {"device_turn_deg", "device_rotation_deg"},
    {"disk_share", "disk_radius_ratio"},
    {"dropout", "dropout_probability"},
    {"dropout_share", "dropout_probability"},
    {"edge_limit_m", "max_edge_length_m"},
    {"empty_frame", "empty_frame_at_s"},
    {"engage_below_N", "engage_force_N"},
    {"farthest_m", "max_depth_m"},
    {"fastest_m_per_s", "max_speed_m_per_s"},
    {"fastest_rad_per_s", "max_angular_speed_rad_per_s"},
    {"fewest_points", "min_points"},
    {"first_gate_m", "initial_gate_m"},
    {"flying_m", "max_flying_distance_m"},
    {"flying_share", "flying_probability"},
    {"force_share", "force_fraction"},
    {"guidance_pulls", "guidance_active"},
    {"hole_share", "hole_fraction"},
    {"largest_energy_given", "max_energy_injected"},
    {"largest_energy_per_update", "max_energy_per_update"},
    {"largest_force", "max_force"},
    {"largest_force_N", "max_force_N"},
    {"largest_force_jump", "max_force_jump"},
    {"largest_height_m", "max_height_m"},
    {"largest_penetration", "max_penetration"},
    {"largest_steps", "max_steps"},
    {"largest_torque_Nm", "max_torque_Nm"},
    {"late_s", "late_delay_s"},
    {"late_share", "late_probability"},
    {"least_lightness", "min_lightness"},
    {"least_saturation", "min_saturation"},
    {"least_slave_distance", "min_slave_distance"},
    {"left_m", "left_valve_position_m"},
    {"longest_prediction_s", "max_prediction_s"},
    {"longest_step_m", "max_step_m"},
    {"most_lightness", "max_lightness"},
    {"most_replicates", "max_replicates"},
    {"moves_x", "force_x"},
    {"moves_y", "force_y"},
    {"moves_z", "force_z"},
    {"non_finite_share", "non_finite_fraction"},
    {"open_at_s", "open_end_s"},
    {"outlier_reach_m", "max_outlier_distance_m"},
    {"outlier_share", "outlier_probability"},
    {"penetration", "tool_penetration"},
    {"per_frame", "surface", "press"},
    {"reopening_at_s", "open_start_s"},
    {"repeat_share", "repeat_probability"},
    {"right_m", "right_valve_position_m"},
    {"rise_frames", "rise_s"},
    {"rise_m", "rise_height_m"},
    {"shear_s", "rolling_shutter_s"},
    {"sheet_spacing_m", "layer_spacing_m", "moving-shape"},
    {"sheets", "layers", "moving-shape"},
    {"stale_s", "max_command_age_s"},
    {"start_m", "start_height_m"},
    {"target_m", "target_position_m"},
    {"tool_leaves", "max_tool_leaves"},
    {"true_motion", "truth", "plates"},
    {"turn_damping_Nms_per_rad", "rotational_damping_Nms_per_rad"},
    {"turn_deg", "max_rotation_deg"},
    {"turn_deg", "rotation_deg"},
    {"turn_stiffness_Nm_per_rad", "rotational_stiffness_Nm_per_rad"},
    {"turns_x", "torque_x"},
    {"turns_y", "torque_y"},
    {"turns_z", "torque_z"},
    {"unconverged_share", "unconverged_fraction"},
    {"vanish_at_frame", "vanish_at_s"},
    {"view", "view_direction", kViewed},
    {"wait_frames", "wait_s"},
    {"widest_gate_m", "max_gate_m"},
    {"within_m", "inner_radius_m"},
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

bool is_known(const std::vector<std::string>& known, const char* name) {
  return std::find(known.begin(), known.end(), name) != known.end();
}

// True if the entry is one of the names in the text.
bool is_owner(std::string_view owners, const std::string& entry) {
  while (!owners.empty()) {
    const std::size_t end = std::min(owners.find(' '), owners.size());
    if (owners.substr(0, end) == entry) return true;
    owners.remove_prefix(std::min(end + 1, owners.size()));
  }
  return false;
}

// True if the entry is not known, or has had the old name. A name of version 0.1 may be of any entry.
bool may_be_of(std::string_view owners, const std::optional<std::string>& entry) {
  return !entry || owners.empty() || is_owner(owners, *entry);
}

}  // namespace

std::span<const RenamedName> renamed_names() {
  return kRenamed;
}

std::span<const RenamedValue> renamed_values() {
  return kRenamedValues;
}

std::optional<std::string> new_name(const std::string& old_name, const std::vector<std::string>& known,
                                    const std::optional<std::string>& entry) {
  for (const RenamedName& name : kRenamed)
    if (old_name == name.old_name && is_known(known, name.new_name) && may_be_of(name.owners, entry))
      return name.new_name;
  return {};
}

std::optional<std::string> new_value(const std::string& setting, const std::string& old_value,
                                     const std::vector<std::string>& known,
                                     const std::optional<std::string>& entry) {
  for (const RenamedValue& value : kRenamedValues)
    if (setting == value.setting && old_value == value.old_value && is_known(known, value.new_value) &&
        may_be_of(value.owners, entry))
      return value.new_value;
  return {};
}

std::optional<std::string> renamed_entry(const std::string& section, const std::string& name) {
  return stored_value(name, section + ".name", name);
}

std::string stored_name(const std::string& entry, const std::string& name) {
  for (const RenamedName& renamed : kRenamed)
    if (name == renamed.old_name && is_owner(renamed.owners, entry)) return renamed.new_name;
  return name;
}

std::optional<std::string> stored_value(const std::string& entry, const std::string& setting,
                                        const std::string& value) {
  for (const RenamedValue& renamed : kRenamedValues)
    if (setting == renamed.setting && value == renamed.old_value && is_owner(renamed.owners, entry))
      return renamed.new_value;
  return {};
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

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

// Returns the key in `now`, the translated object, of a key in `before`; nothing if there is none.
std::optional<std::string> translated_key(const std::string& key, const Json& before, const Json& now) {
  return now.contains(key) ? key : new_name(key, keys_of(now), name_of(before));
}

// Adds the keys and texts of `before` that differ in `now`. A flag that became a text also has a new key, so
// the key lists it.
void add_translated(const Json& before, const Json& now, std::set<std::string>& names) {
  if (before.is_object() && now.is_object()) {
    for (const auto& item : before.items()) {
      const std::optional<std::string> key = translated_key(item.key(), before, now);
      if (!key) continue;
      if (*key != item.key()) names.insert(item.key() + " to " + *key);
      add_translated(item.value(), now.at(*key), names);
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
