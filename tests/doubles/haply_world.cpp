#include "tests/doubles/haply_world.h"

#include <nlohmann/json.hpp>

namespace remote_touch {

namespace {

using nlohmann::json;

json vector_of(const Vec3& v) {
  return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}};
}

json orientation_of(const Eigen::Quaterniond& q) {
  return {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}};
}

json device_of(const HaplyWorld& world, const std::string& id, const Vec3& given_N, bool with_config) {
  const json zeros = {{"a0", 0.0}, {"a1", 0.0}, {"a2", 0.0}};
  // The cursor belongs to the first device. Another device is at another position.
  const Vec3 at = id == world.devices.front() ? world.position_m : Vec3(9, 9, 9);
  json device = {{"device_id", id},
                 {"state",
                  {{"angular_position", zeros},
                   {"angular_velocity", zeros},
                   {"body_orientation", orientation_of(Eigen::Quaterniond::Identity())},
                   {"control_domain", "cartesian"},
                   {"control_mode", "force"},
                   {"current_cursor_position", vector_of(Vec3(7, 7, 7))},
                   {"cursor_position", vector_of(at)},
                   {"cursor_velocity", vector_of(world.velocity_m_per_s)}}},
                 {"status", {{"calibrated", true}, {"in_use", true}, {"ready", true}}}};
  if (world.reports_force) device["state"]["current_cursor_force"] = vector_of(given_N);
  if (with_config)
    device["config"] = {{"type", "inverse3"},
                        {"basis", {{"permutation", world.basis}}},
                        {"handedness", "right"},
                        {"filters", {{"force_gate", {{"gain", 0.3}}}}}};
  return device;
}

std::string message_of(const HaplyWorld& world, const Vec3& given_N, bool is_inventory) {
  json message = {{"inverse3", json::array()}};
  if (is_inventory) message["session_id"] = 7;
  for (const std::string& id : world.devices)
    message["inverse3"].push_back(device_of(world, id, given_N, is_inventory));
  if (world.has_handle) {
    json state = {{"orientation", orientation_of(world.orientation)}, {"hall", 0}};
    if (world.is_handle_wired)
      state["button"] = world.a;
    else
      state["buttons"] = {{"a", world.a}, {"b", world.b}, {"c", world.c}};
    message[world.is_handle_wired ? "verse_grip" : "wireless_verse_grip"] = {
        {{"device_id", "61548"}, {"state", state}, {"status", {{"error", 0}}}}};
  }
  return message.dump();
}

}  // namespace

std::vector<HaplyCommand> haply_commands(const std::string& message) {
  std::vector<HaplyCommand> commands;
  const json parsed = json::parse(message);
  for (const json& device : parsed.at("inverse3"))
    for (const auto& [key, force] : device.at("commands").at("set_cursor_force").items())
      commands.push_back({device.at("device_id"), key, Vec3(force.at("x"), force.at("y"), force.at("z"))});
  return commands;
}

Vec3 given_force_N(const HaplyWorld& world, const HaplyCommand& command) {
  return (command.key == world.force_key ? world.force_factor : 0) * command.force_N + world.other_N;
}

std::string haply_inventory(const HaplyWorld& world, const Vec3& given_N) {
  return world.inventory.empty() ? message_of(world, given_N, true) : world.inventory;
}

std::string haply_state(const HaplyWorld& world, const Vec3& given_N) {
  return world.answer.empty() ? message_of(world, given_N, false) : world.answer;
}

}  // namespace remote_touch
