// A simulated operator: the hand is a mass that springs and dampers pull to the intended path, and that the
// device's force moves. Not in the dissertation, whose operators were people.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/rendering/frame.h"
#include "core/tool/dynamics/tool_pose.h"
#include "core/tool/dynamics/wrench_coupling.h"

namespace remote_touch {

struct OperatorSettings {
  double mass_kg = 0.5;
  double inertia_kg_m2 = 1e-3;
  double stiffness_N_per_m = 300;
  double damping_Ns_per_m = 15;
  double rotational_stiffness_Nm_per_rad = 1;
  double rotational_damping_Nms_per_rad = 0.05;
  std::vector<double> grip{};
  std::vector<double> presses{};
};

Parameters parameters(OperatorSettings& s);
std::string validate(const OperatorSettings& s);

// m x'' = f + g k (x_i - x) + c (g x_i' - x'), with f the device's force, x_i the intended position and g the
// grip; rotations likewise, with the inertia inertia_kg_m2 about every axis. Semi-implicit steps of one tick,
// with the springs at its start and the damper at its end: stable for k tick^2 < 4 m, which validate()
// requires at 100 ticks a second.
class OperatorModel {
 public:
  OperatorModel(const OperatorSettings& settings, double tick_s);

  // Advances one tick: the hand's pose at time_s, if the path is at `intended` and the device exerted
  // device_wrench since the last tick. The first call puts the hand onto the path. Buttons come from the
  // settings.
  DeviceState move(const DeviceState& intended, double time_s, const Wrench& device_wrench);

 private:
  std::uint32_t buttons(double time_s) const;

  const OperatorSettings s_;
  const double tick_s_;
  bool placed_ = false;
  ToolPose pose_, intended_;  // intended_: one tick ago
  Vec3 velocity_ = Vec3::Zero(), angular_velocity_ = Vec3::Zero();
};

}  // namespace remote_touch
