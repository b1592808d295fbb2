// Measures of how true the force is: the stiffness of a press, the force against a known one, and the energy
// that the hand gets.
#pragma once

namespace remote_touch {

struct Trace;

// Measures of a press: the stiffness that the hand feels, and whether the force of the release is that of the
// press. After the stiffness test of N. Fazlollahi and K. J. Kuchenbecker, "Haptify: a measurement-based
// benchmarking system for grounded force-feedback devices", IEEE Trans. Robotics 2022, which presses a device
// into a rendered plane. Here a renderer is tested: the hand follows its script exactly.
//
// The indentation is the depth of the HIP below the true surface. The normal force is the part of the contact
// force, without guidance, along the true normal; it is 0 in a tick without a force. A tick belongs to the
// press if the indentation has grown since the tick before, to the release if it has shrunk, in both cases by
// kPressing_m_per_s or faster. Only ticks with a positive indentation, a known truth and a known force are
// used, also those before the force begins. A sideways motion at constant depth belongs to neither.
//
// Each measure is NaN if Trace::contact or Trace::true_normal is empty, if the ticks that it uses have
// indentations within less than kMinIndentation_m, or if no force of the press pushes out of the surface: a
// penalty force has lost a surface of points as soon as the HIP is below it.

inline constexpr double kPressing_m_per_s = 1e-4;
inline constexpr double kMinIndentation_m = 1e-3;

// Slope of the line of least squares of the normal force over the indentation, during the press, N/m. A
// surface that is rendered too high does not change it. One that is rendered too deep makes it smaller,
// because the ticks before the force begins have a force of 0.
double rendered_stiffness_N_per_m(const Trace& trace);
// The rendered stiffness divided by that of the virtual coupling, minus 1. The coupling's stiffness is the
// slope, in the same ticks, of the normal force over the stretch of the spring: the height of the contact
// point above the HIP, see Trace::TrueContact. So it is not the stiffness that is set: ticks before the force
// begins make both slopes smaller. 0: the contact point stays where it is while the force grows;
// -0.1: it gives way, and the hand feels 10 % less. NaN also if the slope is not above 0.
double stiffness_error(const Trace& trace);
// Root mean square distance of the normal forces of the press from that line, divided by the largest of these
// forces: 0 for a spring.
double stiffness_nonlinearity(const Trace& trace);
// 1 minus the mean normal force of the release divided by that of the press. Both means are over the
// indentation, in the range that both have, and the force is linear between two ticks. 0: a spring without
// loss; 0.1: a tenth of the work of the press is lost; 1: the release has no force; negative: the release
// pushes more.
double stiffness_hysteresis(const Trace& trace);

// Measures of a run that replays a contact whose force is known: the rendered force F against the expected
// force E. After E. Ruffaldi, D. Morris, T. Edmunds, F. Barbagli and D. K. Pai, "Standardized evaluation of
// haptic rendering systems", Haptics Symposium 2006: a probe recorded the force of an object at known
// positions, the same contact is given to a renderer, and its force is compared with the recorded one.
//
// F is the force on the hand without the part of guidance. E is Trace::expected_force_N. Ticks in which E is
// NaN are not used. Every measure is NaN if no tick qualifies. A force that is not finite makes the error
// NaN, and is no contact.

// A rendered force above the first limit counts as contact, an expected one above the second, N. A proxy of
// chapter 4 counts as touching anywhere between r_1 and r_2, so an ideal one may be in error by
// k_s (r_2 - r_1) = 600 N/m times 2e-5 m = 0.012 N. The limits are farther apart than that, so that such an
// error is no lost contact.
inline constexpr double kContactForce_N = 0.02;
inline constexpr double kExpectedContact_N = 0.04;

// Root mean square of |F - E| over all ticks, with and without contact, N.
double rms_force_error_N(const Trace& trace);
// The same divided by the root mean square of |E|: 1 for a renderer that never exerts a force. NaN also if E
// is 0 in all ticks.
double relative_force_error(const Trace& trace);
// Mean angle between F and E, rad, 0 to pi, over the ticks in which both count as contact.
double force_direction_error_rad(const Trace& trace);
// Fraction of the ticks with E = 0 in which F counts as contact.
double false_contact_fraction(const Trace& trace);
// Number of ticks in which E counts as contact and F does not, divided by that of all ticks in which E does.
double lost_contact_fraction(const Trace& trace);

// Energy that the device gives to the hand: force . displacement of the HIP until the next tick, and with a
// tool also torque . rotation. This is the exact work of a force that is held for a tick. A simulated
// operator gains or dissipates all of it (runners/experiment/hand/simulated_hand.h). If the run simulates an
// operator or a device, the force and torque are those that the device exerts with the motors that it has.
// Otherwise they are those that the renderer commands.

// Work on the hand in the whole run, J. Negative if the hand did more work on the surface.
double energy_injected_J(const Trace& trace);

// The maximum over time of the net energy injected into the hand since the start, J; 0 if it was never
// positive. A passive renderer without stored energy at the start cannot exceed 0: the passivity observer of
// B. Hannaford and J.-H. Ryu, IEEE Trans. Robotics and Automation 18 (2002), with the opposite sign.
double max_energy_injected_J(const Trace& trace);

// Work done on the hand from one frame update to the next, J: mean and maximum over the complete intervals in
// which the hand feels a force or a torque. NaN if there is no such interval.
double mean_energy_per_update_J(const Trace& trace);
double max_energy_per_update_J(const Trace& trace);

// The lowest energy of the channel between the hand and a slave in the run, J: in - out of both ports, 0 at
// the start. Negative if the channel has given more than it received, so it is not passive. NaN if the hand
// is not to feel the slave.
double min_channel_energy_J(const Trace& trace);

// Energy that passivity control has kept from leaving this channel, J; 0 with other architectures. NaN as
// above.
double dissipated_energy_J(const Trace& trace);

}  // namespace remote_touch
