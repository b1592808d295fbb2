#include "core/dissertation/tool_motion/tool_parameters.h"

namespace remote_touch {

Parameters parameters(ToolParameters& p) {
  return {
      {"contact_rule", choice(p.contact_rule, {"look-ahead", "voxels", "continuous"}), 0, 0,
       "look-ahead: every near point is a constraint with its signed distance; voxels: points in the tool's voxels are constraints, as printed, 6.2.3 to 6.2.5; continuous: look-ahead, with each step ended before a point enters the tool"},
      {"detections_per_tick", &p.detections_per_tick, 1, 10000,
       "maximum number of collision detections in a tick; a tick that needs more stops and sets budget_exhausted"},
      {"max_step_m", &p.max_step_m, 1e-5, 0.01,
       "s_max of 6.2.5: maximum displacement of any point of the tool in a step"},
      {"free_accuracy_m", &p.free_accuracy_m, 1e-6, 0.01,
       "epsilon_f of 6.2.5: tolerance for finding the first contact; for contact_rule = voxels"},
      {"exit_accuracy_m", &p.exit_accuracy_m, 1e-6, 0.01,
       "epsilon_c of 6.2.5: tolerance for finding the end of a collision; for contact_rule = voxels"},
      {"look_ahead_m", &p.look_ahead_m, 2e-4, 0.005,
       "points (sphere-tree: regions) within this distance of the tool are constraints; not used with contact_rule = voxels"},
      {"disk_radius_ratio", &p.disk_radius_ratio, 0, 2,
       "each point is a disk; its radius is this value times the point spacing, so that corners of the tool do not sink between points; 0: points only; for contact_rule = look-ahead and continuous"},
      {"merged_disk_m", &p.merged_disk_m, 0, 0.005,
       "size of the cubes in which points less than 0.6 mm apart are replaced by one disk if they cover a plane; 0: no "
       "merging; smaller parts of the tool may sink between disk centres; for contact_rule = look-ahead and "
       "continuous (which still checks whether a single point stops a motion)"},
      {"frame_reach_m", &p.frame_reach_m, 0, 0.05,
       "largest motion of a surface in a frame after which a tool that it held is moved out of it; a small "
       "detections_per_tick shortens it; 0: the tool is never moved out; for contact_rule = continuous"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "the tick ends when a step is shorter than this"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "stiffness K of the virtual coupling (6.9)",
       kLive},
      {"gyration_radius_m", &p.gyration_radius_m, 0, 1,
       "rotational stiffness = stiffness times this squared, (6.9)"},
      {"stiffness_ratio", &p.stiffness_ratio, 0, 10,
       "diagonal of K of (6.9): stiffness along x, y, z of the world as a multiple of stiffness_N_per_m"},
      {"rotational_stiffness_ratio", &p.rotational_stiffness_ratio, 0, 10,
       "diagonal of K of (6.9): stiffness about x, y, z of the world as a multiple of the rotational stiffness"},
      {"max_force_N", &p.max_force_N, 0, 1000,
       "maximum magnitude of the force; larger forces are scaled down to it"},
      {"max_torque_Nm", &p.max_torque_Nm, 0, 100,
       "maximum magnitude of the torque; larger torques are scaled down to it"},
      {"torque_rule", choice(p.torque_rule, {"inverse-jacobian", "printed"}), 0, 0,
       "inverse-jacobian: torque of an elastic energy; printed: (6.9) as printed, with the inertia of the tool"},
      {"motion_metric", choice(p.motion_metric, {"tool", "coupling"}), 0, 0,
       "M of (6.4), which says which motion is nearest: tool: the inertia of the tool, as printed; coupling: that of a body with gyration_radius_m about every axis, so that the contacts can push the force and torque on the hand (where stiffness_ratio and rotational_stiffness_ratio are 1)"},
      {"velocity_estimate", &p.velocity_estimate, 0, 1,
       "estimate the velocity of the cloud along the contact normal and move the tool with it, as (4.3), (4.13) do for the proxy; not in the dissertation",
       kLive},
      {"max_prediction_s", &p.max_prediction_s, 0, 10,
       "maximum time after a frame for which its velocity estimate is used"},
      {"velocity_force", choice(p.velocity_force, {"minus", "plus", "none"}), 0, 0,
       "with velocity_estimate: sign of the velocity term of (4.15) in the force on a tool that is held; plus is printed"},
      {"slave_command", choice(p.slave_command, {"tool", "hip"}), 0, 0,
       "pose that the slave robot follows, 5.2: tool: the rendered one; hip: the device's"},
  };
}

double used_merged_disk_m(const ToolParameters& p) {
  return p.contact_rule != ContactRule::voxels && p.disk_radius_ratio > 0 ? p.merged_disk_m : 0;
}

std::string validate(const ToolParameters& p) {
  if (10 * p.rest_threshold_m > p.max_step_m)
    return "rest_threshold_m = " + std::to_string(p.rest_threshold_m) +
           ": expected a tenth of max_step_m or less";
  if (p.contact_rule != ContactRule::voxels && p.look_ahead_m < p.max_step_m)
    return "look_ahead_m = " + std::to_string(p.look_ahead_m) + ": expected max_step_m or more";
  if (p.motion_metric == MotionMetric::coupling && !(p.gyration_radius_m > 0))
    return "gyration_radius_m = 0: expected more with motion_metric = coupling";
  return {};
}

Parameters parameters(EvenCoupling& p) {
  return {
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 1, 10000, "stiffness of the virtual coupling"},
      {"gyration_radius_m", &p.gyration_radius_m, 1e-3, 1,
       "rotational stiffness = stiffness times this squared"},
      {"max_force_N", &p.max_force_N, 0, 1000,
       "maximum magnitude of the force; larger forces are scaled down to it"},
      {"max_torque_Nm", &p.max_torque_Nm, 0, 100,
       "maximum magnitude of the torque; larger torques are scaled down to it"},
  };
}

ToolParameters tool_parameters(const EvenCoupling& p) {
  ToolParameters tool;
  tool.stiffness_N_per_m = p.stiffness_N_per_m, tool.gyration_radius_m = p.gyration_radius_m;
  tool.merged_disk_m = 0;  // none of these methods merges disks
  tool.max_force_N = p.max_force_N, tool.max_torque_Nm = p.max_torque_Nm;
  return tool;
}

}  // namespace remote_touch
