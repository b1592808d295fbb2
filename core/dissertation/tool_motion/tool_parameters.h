// The settings of the 6-DOF renderer of a tool, 6.3, and of the methods for comparison that share its
// coupling.
#pragma once

#include <string>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

// The rule by which contacts limit the motion. look_ahead: constraints from the distance field. voxels: 6.2.3
// to 6.2.5 as printed. continuous: as look_ahead, with certified steps.
enum class ContactRule { look_ahead, voxels, continuous };
enum class MotionMetric { tool, coupling };  // M of (6.4)

// Settings of the 6-DOF renderer, including the choices between different readings of an equation.
struct ToolParameters {
  ContactRule contact_rule = ContactRule::look_ahead;
  int detections_per_tick = 60;
  double max_step_m = 1e-3;       // s_max
  double free_accuracy_m = 1e-4;  // epsilon_f
  double exit_accuracy_m = 1e-4;  // epsilon_c
  double look_ahead_m = 2e-3;
  double disk_radius_ratio = 0.75;
  double merged_disk_m = 2e-3;
  double frame_reach_m = 0.02;
  double rest_threshold_m = 1e-6;
  double stiffness_N_per_m = 600;  // K of (6.9) for a tool of 1 kg
  double gyration_radius_m = 0.03;
  Vec3 stiffness_ratio{1, 1, 1};             // diagonal of K: factors along the world axes
  Vec3 rotational_stiffness_ratio{1, 1, 1};  // factors about the world axes
  double max_force_N = 20;
  double max_torque_Nm = 1;
  TorqueRule torque_rule = TorqueRule::inverse_jacobian;
  MotionMetric motion_metric = MotionMetric::tool;
  bool velocity_estimate = false;  // not in the dissertation
  double max_prediction_s = 0.1;
  VelocityForce velocity_force = VelocityForce::minus;
  SlaveCommand slave_command = SlaveCommand::rendered;
};

Parameters parameters(ToolParameters& p);
// Returns merged_disk_m for the rules that merge disks, else 0. It is also 0 if points have no disks, because
// merged points would then leave gaps.
double used_merged_disk_m(const ToolParameters& p);
std::string validate(const ToolParameters& p);
// Returns an upper bound, over all poses, of how fast the magnitude of the force grows with the displacement
// of the HIP, N/m. It does not cover points that have a stiffness of their own.
inline double max_stiffness_N_per_m(const ToolParameters& p) {
  return p.stiffness_N_per_m * p.stiffness_ratio.maxCoeff();
}

// The settings of the coupling (6.9) with the same stiffness in all directions. The methods for comparison
// share them. The members mean the same as those of ToolParameters.
struct EvenCoupling {
  double stiffness_N_per_m = 600, gyration_radius_m = 0.03;
  double max_force_N = 20, max_torque_Nm = 1;
};

Parameters parameters(EvenCoupling& p);
// Returns an upper bound, over all poses, of how fast the magnitude of the force grows with the displacement
// of the HIP, N/m, for the settings of a method that has this coupling.
template <class Settings>
requires requires(const Settings& s) {
  s.coupling.stiffness_N_per_m;
}
double max_stiffness_N_per_m(const Settings& s) {
  return s.coupling.stiffness_N_per_m;
}
// Returns tool settings with this coupling and without merged disks; the other settings have their defaults.
ToolParameters tool_parameters(const EvenCoupling& p);

// Returns the coupling (6.9) between tool and device, with this stiffness.
inline WrenchSpring coupling_of(const ToolParameters& p, double stiffness_N_per_m) {
  return {stiffness_N_per_m, p.gyration_radius_m,         p.max_force_N, p.max_torque_Nm, p.torque_rule,
          p.stiffness_ratio, p.rotational_stiffness_ratio};
}

}  // namespace remote_touch
