// Changes of the force in units of what a hand perceives: a change is felt where it exceeds a fraction of the
// force before it (Weber's law); 5 to 20 % are common thresholds of force. A change is the length of the
// difference of two force vectors, and the force before is a length as well, so any force that begins counts.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// Fraction of the frame updates at which the force changes by more than weber times the force of the tick
// before, of those at which one of both ticks has a force. NaN without any.
double felt_jump_fraction(const Trace& trace, double weber);
// Packets per second of a connection with a perceptual dead-band (IEEE 1918.1.1): the first tick is sent, and
// each whose force differs from the last one sent by more than weber times that force. NaN with fewer than
// two ticks.
double deadband_packets_per_s(const Trace& trace, double weber);

}  // namespace remote_touch
