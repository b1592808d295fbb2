#include "core/dissertation/proxy/proxy_parameters.h"

#include <sstream>

namespace remote_touch {

Parameters parameters(ProxyParameters& p) {
  return {
      {"r1_m", &p.r1_m, 1e-6, 1,
       "the proxy is entrenched where the distance r_n (5.5) is below this, Fig 4.2, 5.3", kLive},
      {"r2_m", &p.r2_m, 1e-6, 1,
       "the proxy is in contact where the distance is from r1 to this; the contact radius r_c is (r1 + r2) / 2",
       kLive},
      {"r3_m", &p.r3_m, 1e-6, 1, "radius of the points that are averaged to the normal (4.1)", kLive},
      {"theta_deg", &p.theta_deg, 0, 90,
       "convergence angle: a contact has converged when -u and the normal differ by less (4.8)"},
      {"gamma", &p.gamma, 1e-3, 1, "near the goal: step length as a fraction of the distance to it (4.11)"},
      {"xi", &p.xi, 1e-3, 0.999, "far from the goal: step length in units of r1 (4.12)"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "spring k_s of the virtual coupling (4.16)",
       kLive},
      {"damping_Ns_per_m", &p.damping_Ns_per_m, 0, 1000, "damper k_d of the virtual coupling (4.16)"},
      {"steps_per_tick", &p.steps_per_tick, 1, 100000,
       "maximum number of proxy steps in a haptic tick; recommended where time matters: 8 with gamma = 0.5, with which the proxy rests within 20 um of the position of 30 with gamma = 0.3, in 0.3 of the time"},
      {"max_exit_steps", &p.max_exit_steps, 0, 1000,
       "maximum number of extra steps (5.11) when a tick would end inside a forbidden region; 0: as printed"},
      {"velocity_estimate", &p.velocity_estimate, 0, 1,
       "estimate the velocity of the cloud (4.13) and move the proxy with it at each frame (4.3)", kLive},
      {"max_prediction_s", &p.max_prediction_s, 0, 10,
       "maximum time after a frame for which (4.3) and (4.15) extrapolate its motion; at least one frame interval"},
      {"growth_is_motion", &p.growth_is_motion, 0, 1,
       "true: the growth of a region under the proxy counts as motion in (4.13), as printed; false: the change of r_f "
       "between two frames does not count"},
      {"step_rule", choice(p.step_rule, {"variable", "fixed"}), 0, 0,
       "variable: step lengths of 4.2.4; fixed: small steps of one length as in the predecessor [1]"},
      {"fixed_step_m", &p.fixed_step_m, 1e-7, 0.01, "step length of step_rule = fixed"},
      {"free_root", choice(p.free_root, {"ahead", "smallest-magnitude"}), 0, 0,
       "root of (4.9), (5.9): ahead: only points in the direction of motion; smallest-magnitude: as printed"},
      {"contact_motion", choice(p.contact_motion, {"tangent-plane", "regions", "creases"}), 0, 0,
       "motion in contact: tangent-plane: in the plane of the mean normal (4.6), (5.16); regions: as close to the HIP as all touching regions allow; creases: regions where the direction from a touching region is more than 17 deg off the mean normal, else tangent-plane"},
      {"exit_rule", choice(p.exit_rule, {"towards-hip", "out-of-contact"}), 0, 0,
       "for contact_motion = tangent-plane when the HIP is outside: towards-hip: straight to the HIP (4.7); out-of-contact: r2 - r1 along the normal (5.17)"},
      {"velocity_force", choice(p.velocity_force, {"minus", "plus", "none"}), 0, 0,
       "sign of the velocity term of (4.15); plus is printed, but doubles the force jump instead of removing it"},
      {"damping_sign", choice(p.damping_sign, {"plus", "minus"}), 0, 0,
       "sign of the damping term in the bracket of (4.16); minus is printed, but adds energy"},
      {"force_gate", choice(p.force_gate, {"latest-contact", "contact-now"}), 0, 0,
       "latest-contact: send the force (4.16) until the proxy is free for a whole tick; contact-now: only if the tick ends in contact, as printed"},
      {"slave_command", choice(p.slave_command, {"proxy", "hip"}), 0, 0,
       "commanded position of the slave robot: proxy (hard constraint) or hip (soft constraint), 5.2"},
      {"slave_prediction", &p.slave_prediction, 0, 1,
       "in contact: add velocity estimate times age of the frame to the position of the slave"},
  };
}

Parameters with_fixed_radii(Parameters list) {
  for (Parameter& p : list) p.is_live &= p.name != "r1_m" && p.name != "r2_m" && p.name != "r3_m";
  return list;
}

std::string validate(const ProxyParameters& p) {
  std::ostringstream text;
  if (!(p.r1_m < p.r2_m))
    text << "r1_m = " << p.r1_m << ": expected below r2_m = " << p.r2_m;
  else if (!(p.r2_m < p.r3_m))
    text << "r2_m = " << p.r2_m << ": expected below r3_m = " << p.r3_m;
  return text.str();
}

}  // namespace remote_touch
