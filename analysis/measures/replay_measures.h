// Measures of a run that replays a contact whose force is known: the rendered force F against the expected
// force E. After E. Ruffaldi, D. Morris, T. Edmunds, F. Barbagli and D. K. Pai, "Standardized evaluation of
// haptic rendering systems", Haptics Symposium 2006: a probe recorded the force of an object at known
// positions, the same contact is given to a renderer, and its force is compared with the recorded one.
//
// F is the force on the hand without the part of guidance. E is Trace::expected_force_N. Ticks in which E is
// NaN are not used. Every measure is NaN if no tick qualifies. A force that is not finite makes the error
// NaN, and is no contact.
#pragma once

namespace remote_touch {

struct Trace;

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

}  // namespace remote_touch
