#include "analysis/measures/event_times.h"

#include "analysis/measures/force_change_measures.h"
#include "analysis/measures/no_value.h"
#include "analysis/measures/surface_side.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// Returns the first tick i for which happens(i) is true. happens() is called for each tick up to it.
template <class Happens>
double first_tick(const Trace& trace, Happens&& happens) {
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (happens(i)) return static_cast<double>(i);
  return kNoValue;
}

double time_of(const Trace& trace, double tick) {
  return tick >= 0 ? trace.time_s[static_cast<std::size_t>(tick)] : kNoValue;
}

}  // namespace

double first_contact_tick(const Trace& trace) {
  return first_tick(trace, [&](std::size_t i) { return trace.contact_count[i] > 0; });
}

double first_contact_time_s(const Trace& trace) {
  return time_of(trace, first_contact_tick(trace));
}

double first_pop_through_tick(const Trace& trace) {
  SurfaceSide side(trace.held_depth_m);
  return first_tick(trace, [&](std::size_t i) { return side.add(trace.signed_distance_m[i]); });
}

double first_pop_through_time_s(const Trace& trace) {
  return time_of(trace, first_pop_through_tick(trace));
}

double max_force_jump_time_s(const Trace& trace) {
  return time_of(trace, max_force_jump_tick(trace));
}

}  // namespace remote_touch
