// Measures of a force in the units in which a hand perceives it: Weber fractions, friction and ripple.
// perceived_force_measures.h counts how often a change is felt; the measures here state how large the changes
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
#pragma once

namespace remote_touch {

struct Trace;

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

}  // namespace remote_touch
