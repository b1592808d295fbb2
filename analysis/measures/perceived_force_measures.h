// Changes of the force relative to what a hand perceives: a change is felt if it exceeds a fraction of the
// force before it (Weber's law); 5 to 20 % are common Weber fractions of force. A change is the magnitude of
// the difference of two force vectors, and the force before it is a magnitude too. So a force that begins
// always counts. No person was tested.
#pragma once

namespace remote_touch {

struct Trace;

// Fraction of the frame updates at which the force changes by more than weber times the force of the tick
// before. Only updates with a force in at least one of the two ticks count; NaN if there are none, or if one
// of these forces is unknown. weber: the Weber fraction, for example 0.1.
double felt_jump_fraction(const Trace& trace, double weber);
// Packets per second of a connection with a perceptual dead-band (IEEE 1918.1.1): the first tick is sent, and
// then each tick whose force differs from the last force sent by more than weber times that force. NaN with
// fewer than two ticks, or if a force is unknown.
double deadband_packets_per_s(const Trace& trace, double weber);

}  // namespace remote_touch
