// How far the rendered surface lies from the true one, by one rule for every renderer: the height of the
// point that touches over the true surface, Trace::contact (what that point is: rendered_contact.h). Both
// sides count, and the worst tick, not the last.
//
// Judged are the settled ticks: those in which the HIP has been below the true surface for kSettling_s
// without a break, so that every renderer must hold it back. Which they are does not depend on the renderer
// where the hand follows a path. Of them, those with a known truth at the point that touches.
//
// NaN where no tick settled, where the truth is known in none of them, or where Trace::contact is empty.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

inline constexpr double kSettling_s = 0.1;

// Maximum distance from the true surface on either side, m; of those below it (0 if none was), and of those
// above it.
double max_contact_error_m(const Trace& trace);
double max_sink_m(const Trace& trace);
double max_float_m(const Trace& trace);
// Root mean square of the height, m.
double rms_contact_error_m(const Trace& trace);
// Fraction of the settled ticks with a force; NaN where none settled.
double contact_force_fraction(const Trace& trace);
// Fraction of the settled ticks with a known truth; NaN where none settled.
double contact_known_fraction(const Trace& trace);

}  // namespace remote_touch
