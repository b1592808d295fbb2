// Time, s, and tick of events in a run; NaN if the event did not happen.
#pragma once

namespace remote_touch {

struct Trace;

// The first tick in which the proxy or tool touches a point or a region (contact_count).
double first_contact_tick(const Trace& trace);
double first_contact_time_s(const Trace& trace);
// The first tick in which the proxy's centre (with a tool its centre of mass) passes to the back of the
// surface by which the run is judged, see surface_side.h. It may come back later; popped_through() considers
// only the last tick.
double first_pop_through_tick(const Trace& trace);
double first_pop_through_time_s(const Trace& trace);
// The time of max_force_jump_tick(), see force_change_measures.h.
double max_force_jump_time_s(const Trace& trace);

}  // namespace remote_touch
