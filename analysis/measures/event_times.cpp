#include "analysis/measures/event_times.h"

#include "analysis/measures/first_tick.h"
#include "analysis/measures/force_change_measures.h"
#include "analysis/measures/surface_side.h"

namespace remote_touch {

double first_contact_tick(const Trace& trace) {
  return first_tick(trace, [&](std::size_t i) { return trace.contact_count[i] > 0; });
}

double first_contact_time_s(const Trace& trace) {
  return time_of(trace, first_contact_tick(trace));
}

double first_pop_through_tick(const Trace& trace) {
  return side_of_run(trace, judged_distance_m(trace)).first_pop_through_tick;
}

double first_pop_through_time_s(const Trace& trace) {
  return time_of(trace, first_pop_through_tick(trace));
}

double max_force_jump_time_s(const Trace& trace) {
  return time_of(trace, max_force_jump_tick(trace));
}

}  // namespace remote_touch
