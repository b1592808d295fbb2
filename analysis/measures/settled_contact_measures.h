// Distance of the rendered surface from the true one, by one rule for every renderer: the height of the
// contact point above the true surface, Trace::contact (rendered_contact.h defines the contact point). Both
// sides count, and so does every tick, not only the last.
//
// Only settled ticks are judged: those in which the HIP has been below the true surface for kSettling_s
// without a break, so that every renderer must hold it back. Where the hand follows a path, they are the same
// for every renderer. Settled ticks in which the truth at the contact point is not known are left out.
//
// NaN if no tick settled, if the truth is known in none of them, or if Trace::contact is empty.
#pragma once

namespace remote_touch {

struct Trace;

inline constexpr double kSettling_s = 0.1;

// Maximum distance of the contact point from the true surface, m: on either side; below it (0 if it never
// was); above it (0 if it never was).
double max_contact_error_m(const Trace& trace);
double max_sink_m(const Trace& trace);
double max_float_m(const Trace& trace);
// Root mean square of the height of the contact point, m.
double rms_contact_error_m(const Trace& trace);
// Fraction of the settled ticks with a force; NaN if no tick settled.
double contact_force_fraction(const Trace& trace);
// Fraction of the settled ticks in which the truth is known; NaN if no tick settled.
double contact_known_fraction(const Trace& trace);

}  // namespace remote_touch
