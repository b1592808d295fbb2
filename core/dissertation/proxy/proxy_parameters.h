// Settings of the point cloud proxy, Table 4.2, and the readings of an equation that can be chosen.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

enum class StepRule { variable, fixed };            // 4.2.4, or the small fixed steps of the predecessor [1]
enum class FreeRoot { ahead, smallest_magnitude };  // root of (4.9); the second is the printed text
// Motion in contact. tangent_plane: (4.6), (5.16). regions: each touching region limits the motion by itself.
// creases: as regions in a crease, as tangent_plane elsewhere.
enum class ContactMotion { tangent_plane, regions, creases };
enum class ExitRule { towards_hip, out_of_contact };  // step in contact with the HIP outside: (4.7) or (5.17)
enum class DampingSign { plus, minus };  // sign of the k_d term in the bracket of (4.16); minus is printed
enum class ForceGate { latest_contact, contact_now };  // condition for sending (4.16); the second is printed

struct ProxyParameters {
  double r1_m = 0.00499;
  double r2_m = 0.00501;
  double r3_m = 0.01;
  double theta_deg = 0.1;
  double gamma = 0.3;
  double xi = 0.1;
  double stiffness_N_per_m = 600;
  double damping_Ns_per_m = 0;
  int steps_per_tick = 30;
  int max_exit_steps = 10;
  bool velocity_estimate = true;
  double max_prediction_s = 0.1;
  bool growth_is_motion = true;
  StepRule step_rule = StepRule::variable;
  double fixed_step_m = 1e-4;
  FreeRoot free_root = FreeRoot::ahead;
  ContactMotion contact_motion = ContactMotion::tangent_plane;
  ExitRule exit_rule = ExitRule::towards_hip;
  VelocityForce velocity_force = VelocityForce::minus;
  DampingSign damping_sign = DampingSign::plus;
  ForceGate force_gate = ForceGate::latest_contact;
  SlaveCommand slave_command = SlaveCommand::rendered;
  bool slave_prediction = false;  // not in the dissertation

  // The contact point lies in the middle of the contact region, 4.2.1.
  double contact_radius_m() const { return 0.5 * (r1_m + r2_m); }
};

Parameters parameters(ProxyParameters& p);
std::string validate(const ProxyParameters& p);
// Returns the list with r1, r2 and r3 fixed during a run, for methods that derive lengths from these radii.
Parameters with_fixed_radii(Parameters list);
// Returns an upper bound, over all poses, of how fast the magnitude of the force grows with the displacement
// of the HIP, N/m. It does not cover the damper, nor points that have a stiffness of their own.
inline double max_stiffness_N_per_m(const ProxyParameters& p) {
  return p.stiffness_N_per_m;
}
// The same for the settings of a method that has a proxy.
template <class Settings>
requires requires(const Settings& s) {
  s.proxy.stiffness_N_per_m;
}
double max_stiffness_N_per_m(const Settings& s) {
  return max_stiffness_N_per_m(s.proxy);
}

}  // namespace remote_touch
