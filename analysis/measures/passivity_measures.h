// Energy that a renderer gives to the hand, observed at the device alone: force . displacement of the HIP
// until the next tick, which is the work done on a hand that moves under that force.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// The maximum over time of the net energy injected into the hand since the start, J; 0 if it was never
// positive. A passive renderer without stored energy at the start cannot exceed 0: the passivity observer of
// B. Hannaford and J.-H. Ryu, IEEE Trans. Robotics and Automation 18 (2002), with the opposite sign.
double max_energy_injected_J(const Trace& trace);

// Work done on the hand from one frame update to the next, over the complete intervals with force: mean and
// maximum, J. NaN without any.
double mean_energy_per_update_J(const Trace& trace);
double max_energy_per_update_J(const Trace& trace);

}  // namespace remote_touch
