#include "core/proxy/proxy_parameters.h"

#include <sstream>

namespace remote_touch {

Parameters parameters(ProxyParameters& p) {
  return {
      {"r1_m", &p.r1_m, 1e-6, 1, "a region r_n nearer than this (5.5) entrenches the proxy, Fig 4.2, 5.3"},
      {"r2_m", &p.r2_m, 1e-6, 1,
       "a point nearer than this touches it; the contact radius r_c is (r1 + r2) / 2"},
      {"r3_m", &p.r3_m, 1e-6, 1, "points nearer than this form the normal (4.1)"},
      {"theta_deg", &p.theta_deg, 0, 90, "angle below which a contact counts as converged (4.8)"},
      {"gamma", &p.gamma, 1e-3, 1, "share of the way that a contact step takes near the goal (4.11)"},
      {"xi", &p.xi, 1e-3, 0.999, "contact step far from the goal, in units of r1 (4.12)"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "spring k_s of the virtual coupling (4.16)"},
      {"damping_Ns_per_m", &p.damping_Ns_per_m, 0, 1000, "damper k_d of the virtual coupling (4.16)"},
      {"steps_per_tick", &p.steps_per_tick, 1, 100000, "largest number of proxy steps in a haptic tick"},
      {"max_exit_steps", &p.max_exit_steps, 0, 1000,
       "in clouds with forbidden regions: further steps (5.11) of a tick that would end inside one; 0: as printed"},
      {"velocity_estimate", &p.velocity_estimate, 0, 1,
       "carry the proxy with the cloud at updates (4.3), (4.13)"},
      {"max_prediction_s", &p.max_prediction_s, 0, 10,
       "(4.3) carries the proxy, and (4.15) the force, no longer than this beyond a frame (or one frame interval)"},
      {"step_rule", choice(p.step_rule, {"variable", "fixed"}), 0, 0,
       "step sizes of 4.2.4, or fixed small steps as in the predecessor [1]"},
      {"fixed_step_m", &p.fixed_step_m, 1e-7, 0.01, "step length of the fixed rule"},
      {"free_root", choice(p.free_root, {"ahead", "smallest_magnitude"}), 0, 0,
       "root of (4.9), (5.9): of points ahead only, or of smallest magnitude as printed"},
      {"contact_rule", choice(p.contact_rule, {"tangent_plane", "regions"}), 0, 0,
       "in contact: in the plane of the mean normal (4.6), (5.16), or as near to the HIP as every touching region allows"},
      {"exit_rule", choice(p.exit_rule, {"towards_hip", "out_of_contact"}), 0, 0,
       "tangent plane, HIP outside: straight to the HIP (4.7), or r2 - r1 along the normal (5.17); regions need none"},
      {"velocity_force", choice(p.velocity_force, {"minus", "plus", "none"}), 0, 0,
       "sign of the velocity term of (4.15); plus is printed and doubles the jump it should remove"},
      {"damping_sign", choice(p.damping_sign, {"plus", "minus"}), 0, 0,
       "sign of the damping term inside the bracket of (4.16); minus is printed and feeds energy in"},
      {"force_gate", choice(p.force_gate, {"latest_contact", "contact_now"}), 0, 0,
       "send (4.16) from the latest contact, or only when the tick ends in contact as printed"},
      {"slave_command", choice(p.slave_command, {"proxy", "hip"}), 0, 0,
       "where the slave robot is sent: to the proxy, a hard constraint, or to the HIP, a soft one, 5.2"},
      {"slave_prediction", &p.slave_prediction, 0, 1,
       "in contact, send the slave ahead of the proxy by the velocity estimate times the age of the frame"},
  };
}

std::string validate(const ProxyParameters& p) {
  std::ostringstream text;
  if (!(p.r1_m < p.r2_m))
    text << "r1_m = " << p.r1_m << ": allowed below r2_m = " << p.r2_m;
  else if (!(p.r2_m < p.r3_m))
    text << "r2_m = " << p.r2_m << ": allowed below r3_m = " << p.r3_m;
  return text.str();
}

}  // namespace remote_touch
