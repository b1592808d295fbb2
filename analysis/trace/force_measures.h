// Measures of the force on the hand: how it changes from tick to tick, what a hand perceives of that, and how
// true it is.
#pragma once

#include <span>

namespace remote_touch {

struct Trace;

// Change of the force on the hand, without the part of guidance, from one tick to the next: at frame updates
// (jump) and between them (noise). A change counts if at least one of its two ticks has a force, so the
// beginning and the end of a force count too. Every value is NaN if a force is unknown in a tick that counts.

// Maximum and root mean square of the change of force at ticks with a new frame, N. NaN if no change counts.
double max_force_jump_N(const Trace& trace);
double rms_force_jump_N(const Trace& trace);
// The first tick with the change that max_force_jump_N() returns. NaN if no change counts or all are 0.
double max_force_jump_tick(const Trace& trace);
// Root mean square change of the force at the other ticks, N. NaN if no change counts.
double force_noise_N(const Trace& trace);

// The same measures for the torque about the HIP, N m. NaN without a tool.
double max_torque_jump_Nm(const Trace& trace);
double rms_torque_jump_Nm(const Trace& trace);
double torque_noise_Nm(const Trace& trace);

// Settling of the force after a touch. The final force is the mean magnitude of the force of contact over the
// last kFinal_s of the run. A run has these measures only if the force is steady at its end: if all
// magnitudes of that time are within kSettledBand of the final force. NaN otherwise, without a final force,
// and if a force is unknown.
inline constexpr double kFinal_s = 0.1, kSettledBand = 0.05;
// The largest magnitude of the run divided by the final force, minus 1; 0 if the force rises to it evenly.
double force_overshoot(const Trace& trace);
// Time from the first tick with a force to the first tick from which on all magnitudes are within
// kSettledBand of the final force, s. 0 for a force that is there at once.
double force_settling_time_s(const Trace& trace);

// Changes of the force relative to what a hand perceives: a change is felt if it exceeds a fraction of the
// force before it (Weber's law); 5 to 20 % are common Weber fractions of force. A change is the magnitude of
// the difference of two force vectors, and the force before it is a magnitude too. So a force that begins
// always counts. No person was tested.

// Fraction of the frame updates at which the force changes by more than weber times the force of the tick
// before. Only updates with a force in at least one of the two ticks count; NaN if there are none, or if one
// of these forces is unknown. weber: the Weber fraction, for example 0.1.
double felt_jump_fraction(const Trace& trace, double weber);
// Packets per second of a connection with a perceptual dead-band (IEEE 1918.1.1): the first tick is sent, and
// then each tick whose force differs from the last force sent by more than weber times that force. NaN with
// fewer than two ticks, or if a force is unknown.
double deadband_packets_per_s(const Trace& trace, double weber);

// Measures of a force in the units in which a hand perceives it: Weber fractions, friction and ripple.
// felt_jump_fraction() counts how often a change is felt; the measures here state how large the changes
// are. No person was tested. A user compares the values with published thresholds:
//
// - A constant force between 2.5 and 10 N must change by about 7 % before the change is noticed (X. D. Pang,
//   H. Z. Tan, N. I. Durlach, "Manual discrimination of force using active finger motion", Perception &
//   Psychophysics 49, 1991).
// - People distinguish two frictions of a force-feedback device if their coefficients differ by
//   0.056 (at a coefficient of 0.2) to 0.150 (at 0.8) (W. R. Provancher, N. D. Sylvester, "Fingerpad skin
//   stretch increases the perception of virtual friction", IEEE Trans. Haptics 2, 2009). A decrease of
//   friction under a sliding finger is noticed from 11 % of the tangential force on (D. Gueorguiev et al.,
//   "The tactile perception of transient changes in friction", J. R. Soc. Interface 14, 2017).
// - The threshold of a vibration depends on its frequency and on the grip: A. Israr, S. Choi, H. Z. Tan,
//   "Mechanical impedance of the hand holding a spherical tool at threshold and suprathreshold stimulation
//   levels", World Haptics 2007, have it as a force, from 10 to 500 Hz.

// The smallest force before a change that has a Weber fraction, N. Smaller forces would have huge ones, and
// near its threshold a force does not follow Weber's law.
inline constexpr double kMinWeberForce_N = 0.1;

// The Weber fraction of a change of force: |F_i - F_(i-1)| / |F_(i-1)|, with magnitudes of vectors, if
// |F_(i-1)| is at least kMinWeberForce_N. 1: the force ends, or it doubles. Maximum over the ticks with a
// frame update (jump), and over the other ticks (change). NaN if there is no such tick, or if a force of
// such a tick is unknown.
//
// A hand that presses changes the force in every tick, also without a frame. So a jump is the change minus
// the one of the tick before, F_(i-1) - F_(i-2), if that tick had no update and there was a force in both.
double max_relative_jump(const Trace& trace);
double max_relative_change(const Trace& trace);

// The speed of the HIP along the surface from which it slides, m/s.
inline constexpr double kSliding_m_per_s = 0.001;

// The coefficient of friction that the hand feels on a surface that has none: the mean force against the
// direction of sliding divided by the mean force along the normal. Means over the ticks in contact whose true
// normal n is known (Trace::true_normal), in which F pushes out of the surface (F.n > 0) and the HIP has
// moved along the surface since the tick before, with kSliding_m_per_s or more. F is the force without
// guidance. Coulomb friction of coefficient mu has the value mu. A force that pulls the hand along has a
// negative value. Tilts of the force to all sides cancel here; mean_lateral_force() includes them. The
// surface must be at rest along itself. Ticks with an unknown force do not count. NaN if no tick counts.
double apparent_friction(const Trace& trace);

// The ripple of the force: root mean square of |F - its mean over the window of kRippleWindow_s around the
// tick|, N. Only ticks whose whole window is in contact (a force in each of its ticks) count, so that the
// beginning and the end of a force are no ripple. A force that is linear in time has no ripple. A sine of
// frequency f counts with the factor |1 - sin(pi f T) / (pi f T)|, T = kRippleWindow_s: 0.06 at 2 Hz, 0.36 at
// 5 Hz, 0.71 at 7.4 Hz, 1 at 10 Hz, at most 1.22. NaN if no tick counts, or if the window has fewer than
// three ticks.
inline constexpr double kRippleWindow_s = 0.1;
double force_ripple_N(const Trace& trace);
// The same divided by the mean of |F| over the same ticks.
double relative_ripple(const Trace& trace);

// Published thresholds of perception, for the measures that are in the same unit. A measure below its
// threshold would probably not be noticed by a hand under the conditions of the source. No person was tested
// here.
//
// relative_ripple has no threshold here: that of a vibration is a force in N which depends on its frequency
// and on the grip (see above), so that no single ratio was published.

struct PerceptionThreshold {
  const char* measure;  // name of the measure, see measures.h
  const char* unit;     // unit of the measure and of the threshold
  double value;         // positive
  const char* meaning;  // one line: "THRESHOLD is MEANING"
  const char* source;   // authors, title and year
};

// The thresholds, in the order in which they are shown. A measure has at most one.
std::span<const PerceptionThreshold> perception_thresholds();

// True if the magnitude of the measure is below the threshold. False for NaN.
bool is_below(const PerceptionThreshold& threshold, double value);

// Measures of how true the force is: the stiffness of a press, the force against a known one, and the energy
// that the hand gets.

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
