#include "runners/experiment/settings/renamed_names.h"

#include <algorithm>
#include <string_view>

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

}  // namespace remote_touch
