// Energy that a renderer gives to the hand, seen at the device alone: force times the way of the HIP until
// the next tick, which is the work done on a hand that moves under that force.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// The maximum over time of the energy injected into the hand since the beginning, J; 0 when it never had more
// than it gave. A passive renderer without stored energy at the beginning cannot exceed 0: the observer of B.
// Hannaford and J.-H. Ryu, IEEE Trans. Robotics and Automation 18 (2002), read from the other side.
double max_energy_injected_J(const Trace& trace);

// Work done on the hand from one frame update to the next, over the whole pieces between updates in which
// there was force: their mean and the largest, J. NaN without any.
double mean_energy_per_update_J(const Trace& trace);
double max_energy_per_update_J(const Trace& trace);

}  // namespace remote_touch
