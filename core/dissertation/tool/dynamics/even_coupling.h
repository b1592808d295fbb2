// The settings of the coupling (6.9) with the same stiffness in all directions. The methods for comparison
// share them.
#pragma once

#include "core/dissertation/tool/dynamics/tool_parameters.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// The members mean the same as those of ToolParameters.
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

}  // namespace remote_touch
