// Distance of the rendered surface from the true one, by one rule for every renderer: the height of the
// contact point above the true surface, Trace::contact (rendered_contact.h defines the contact point). Both
// sides count, and so does every tick, not only the last.
//
// Only settled ticks are judged: those in which the renderer has had a frame and the HIP has been below the
// true surface for kSettling_s without a break, so that every renderer must hold it back. If the hand follows
// a prescribed path, they are the same for every renderer. The measures of a distance skip settled ticks in
// which the truth at the contact point is not known.
//
// Every measure is NaN if no tick is settled or if Trace::contact is empty. A measure of a distance is also
// NaN if no settled tick has a known truth.
#pragma once

namespace remote_touch {

struct Trace;

inline constexpr double kSettling_s = 0.1;

// Maximum distance of the contact point from the true surface, m, on either side of it (max_contact_error_m),
// below it (max_sink_m, 0 if it never was below) and above it (max_float_m, 0 if it never was above).
double max_contact_error_m(const Trace& trace);
double max_sink_m(const Trace& trace);
double max_float_m(const Trace& trace);
// Root mean square of the height of the contact point, m.
double rms_contact_error_m(const Trace& trace);
// The two parts of that height if the run has a measured surface beside the true one. The error of the
// renderer is the height of the contact point above the measured surface. The error of the camera is the
// height of the measured surface above the true one, at the contact point. Root mean squares, and the mean of
// the camera's error, m, over the settled ticks in which both surfaces are known.
double rms_renderer_error_m(const Trace& trace);
double rms_camera_error_m(const Trace& trace);
double mean_camera_error_m(const Trace& trace);
// Fraction of the settled ticks with a force of contact, which excludes guidance; NaN if no tick settled.
double contact_force_fraction(const Trace& trace);
// Fraction of the settled ticks in which the truth is known; NaN if no tick settled.
double contact_known_fraction(const Trace& trace);

}  // namespace remote_touch
