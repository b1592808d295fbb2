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
#pragma once

namespace remote_touch {

struct Trace;

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

}  // namespace remote_touch
