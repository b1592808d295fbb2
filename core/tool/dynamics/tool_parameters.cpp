#include "core/tool/dynamics/tool_parameters.h"

namespace remote_touch {

Parameters parameters(ToolParameters& p) {
  return {
      {"contact_rule", choice(p.contact_rule, {"look-ahead", "voxels"}), 0, 0,
       "how points hold the tool: by their distance from it, ahead and on the side that they touch, or by its "
       "voxels as printed, 6.2.3 to 6.2.5"},
      {"detections_per_tick", &p.detections_per_tick, 1, 10000,
       "collision detections in a tick at most; the tool then waits for the next tick and says so"},
      {"max_step_m", &p.max_step_m, 1e-5, 0.01, "s_max of 6.2.5: motion of any point of the tool in a step"},
      {"free_accuracy_m", &p.free_accuracy_m, 1e-6, 0.01,
       "epsilon_f of 6.2.5: how finely the first contact is found; contact_rule voxels"},
      {"exit_accuracy_m", &p.exit_accuracy_m, 1e-6, 0.01,
       "epsilon_c of 6.2.5: how finely the end of a collision is found; contact_rule voxels"},
      {"look_ahead_m", &p.look_ahead_m, 2e-4, 0.005,
       "points so near to the tool are constraints with their distance; contact_rule look-ahead"},
      {"disk_radius_ratio", &p.disk_radius_ratio, 0, 2,
       "a point stands for a disk of this share of the spacing around it, so that corners do not sink between "
       "points; 0: points only; contact_rule look-ahead"},
      {"rest_threshold_m", &p.rest_threshold_m, 0, 1e-3, "a smaller step ends the tick"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "K of (6.9)"},
      {"gyration_radius_m", &p.gyration_radius_m, 0, 1,
       "the rotational stiffness is stiffness times its square, (6.9) with K = k I"},
      {"max_force_N", &p.max_force_N, 0, 1000, "longer forces are cut to this length"},
      {"max_torque_Nm", &p.max_torque_Nm, 0, 100, "longer torques are cut to this length"},
      {"torque_rule", choice(p.torque_rule, {"inverse-jacobian", "printed"}), 0, 0,
       "torque as the derivative of an elastic energy, or (6.9) as printed with the tool's own inertia"},
      {"velocity_estimate", &p.velocity_estimate, 0, 1,
       "carry (4.3), (4.13) over to the normal of contact; the dissertation has none for the tool"},
      {"max_prediction_s", &p.max_prediction_s, 0, 10, "how long after a frame its velocity estimate counts"},
  };
}

std::string validate(const ToolParameters& p) {
  if (10 * p.rest_threshold_m > p.max_step_m)
    return "rest_threshold_m = " + std::to_string(p.rest_threshold_m) +
           ": allowed a tenth of max_step_m or less";
  if (p.contact_rule == TouchRule::look_ahead && p.look_ahead_m < p.max_step_m)
    return "look_ahead_m = " + std::to_string(p.look_ahead_m) + ": allowed max_step_m or more";
  return {};
}

}  // namespace remote_touch
