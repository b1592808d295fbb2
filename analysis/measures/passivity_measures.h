// Energy that the device gives to the hand: force . displacement of the HIP until the next tick, and with a
// tool torque . rotation. This is the exact work of a force that is held for a tick; a simulated operator
// gains or dissipates all of it (runners/operator/held_force_step.h). Where the run simulates an operator or
// a device, the force and torque are what the device exerts with the motors that it has, else what the
// renderer commands.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// Work on the hand in the whole run, J. Negative if the hand did more work on the surface.
double energy_injected_J(const Trace& trace);

// The maximum over time of the net energy injected into the hand since the start, J; 0 if it was never
// positive. A passive renderer without stored energy at the start cannot exceed 0: the passivity observer of
// B. Hannaford and J.-H. Ryu, IEEE Trans. Robotics and Automation 18 (2002), with the opposite sign.
double max_energy_injected_J(const Trace& trace);

// Work done on the hand from one frame update to the next, over the complete intervals in which the hand
// feels a force or a torque: mean and maximum, J. NaN without any.
double mean_energy_per_update_J(const Trace& trace);
double max_energy_per_update_J(const Trace& trace);

}  // namespace remote_touch
