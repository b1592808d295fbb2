#include "analysis/measures/run_events.h"

#include <cmath>

#include "analysis/measures/force_measures.h"

namespace remote_touch {

bool SurfaceSide::add(double signed_distance_m) {
  is_known_ = !std::isnan(signed_distance_m);
  if (!is_known_) {
    was_unknown_ = true;
    return false;
  }
  if (signed_distance_m >= -held_depth_m_) {
    side_ = Side::front, was_unknown_ = false;
    return false;
  }
  if (side_ == Side::back) return false;
  const bool pops_through = side_ == Side::front && !was_unknown_;
  result_if_behind_ = was_unknown_ ? kNoValue : (pops_through ? 1 : 0);
  side_ = Side::back;
  return pops_through;
}

double SurfaceSide::popped_through() const {
  if (!is_known_) return kNoValue;
  return side_ == Side::back ? result_if_behind_ : 0;
}

SideOfRun side_of_run(const Trace& trace, const std::vector<double>& distance_m) {
  SurfaceSide side(trace.held_depth_m);
  double first = kNoValue;
  for (std::size_t i = 0; i < distance_m.size(); ++i)
    if (trace.frame_index[i] >= 0 && side.add(distance_m[i]) && std::isnan(first))
      first = static_cast<double>(i);
  return {side.popped_through(), first};
}

const std::vector<double>& judged_distance_m(const Trace& trace) {
  return trace.has_measured_surface() ? trace.measured_distance_m : trace.signed_distance_m;
}

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
