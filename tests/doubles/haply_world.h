// The devices behind a simulated Inverse service, and the messages that describe them.
#pragma once

#include <string>
#include <vector>

#include "core/points/vector.h"

namespace remote_touch {

// All vectors are in the service's axes: x to the right, y away from the user, z up.
struct HaplyWorld {
  Vec3 position_m = Vec3(0.01, -0.12, 0.15), velocity_m_per_s = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool a = false, b = false, c = false;

  std::vector<std::string> devices = {"049D"};
  bool has_handle = true;
  bool is_handle_wired = false;
  std::string basis = "XYZ";
  std::string force_key = "vector";  // the key that it knows; it ignores other keys
  bool reports_force = true;
  double force_factor = 1;      // the force that it gives, per commanded force
  Vec3 other_N = Vec3::Zero();  // force that other programs command
  std::string answer;           // sent instead of a state
  std::string inventory;        // sent instead of the inventory
};

struct HaplyCommand {
  std::string device_id, key;
  Vec3 force_N = Vec3::Zero();
};

std::vector<HaplyCommand> haply_commands(const std::string& message);
// Returns the force that the first device of the world gives after such a command.
Vec3 given_force_N(const HaplyWorld& world, const HaplyCommand& command);
// given_N is the force that the device gives now.
std::string haply_inventory(const HaplyWorld& world, const Vec3& given_N);
std::string haply_state(const HaplyWorld& world, const Vec3& given_N);

}  // namespace remote_touch
