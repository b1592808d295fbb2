#include "analysis/measures/tool_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

// Mean of of(i) over the ticks of a run with a tool; NaN without a tool or without ticks.
template <class Value>
double mean(const Trace& trace, Value&& of) {
  if (!trace.has_tool() || trace.length() == 0) return kNoValue;
  double sum = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) sum += of(i);
  return sum / static_cast<double>(trace.length());
}

template <class Value>
double max(const Trace& trace, Value&& of) {
  if (!trace.has_tool() || trace.length() == 0) return kNoValue;
  double found = of(0);
  for (std::size_t i = 1; i < trace.length(); ++i) found = std::max<double>(found, of(i));
  return found;
}

double angle_rad(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return rotation_vector(to * from.conjugate()).norm();
}

double lag_m(const Trace& trace, std::size_t i) {
  return (trace.hip_position_m[i] - trace.proxy_position_m[i]).norm();
}

double lag_rad(const Trace& trace, std::size_t i) {
  return angle_rad(trace.tool_orientation[i], trace.hip_orientation[i]);
}

std::optional<std::size_t> last_guided_tick(const Trace& trace) {
  for (std::size_t i = trace.guidance_active.size(); i > 0; --i)
    if (trace.guidance_active[i - 1] != 0) return i - 1;
  return std::nullopt;
}

}  // namespace

double max_torque_Nm(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return trace.torque_Nm[i].norm(); });
}

double mean_contact_count(const Trace& trace) {
  return mean(trace, [&](std::size_t i) { return trace.contact_count[i]; });
}

double max_contact_count(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return trace.contact_count[i]; });
}

double mean_active_constraints(const Trace& trace) {
  return mean(trace, [&](std::size_t i) { return trace.active_constraints[i]; });
}

double max_active_constraints(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return trace.active_constraints[i]; });
}

double max_contact_clusters(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return trace.contact_clusters[i]; });
}

double max_tool_penetration_m(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return trace.tool_penetration_m[i]; });
}

double min_clearance_m(const Trace& trace) {
  if (!trace.has_tool()) return kNoValue;
  double found = std::numeric_limits<double>::infinity();
  for (const double gap_m : trace.nearest_distance_m) found = std::min(found, gap_m);  // ignores NaN
  return std::isinf(found) ? kNoValue : found;
}

double mean_detections(const Trace& trace) {
  return mean(trace, [&](std::size_t i) { return trace.detections[i]; });
}

double max_detections(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return trace.detections[i]; });
}

double exhausted_fraction(const Trace& trace) {
  return mean(trace, [&](std::size_t i) { return trace.budget_exhausted[i]; });
}

double mean_tool_lag_m(const Trace& trace) {
  return mean(trace, [&](std::size_t i) { return lag_m(trace, i); });
}

double max_tool_lag_m(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return lag_m(trace, i); });
}

double mean_tool_lag_rad(const Trace& trace) {
  return mean(trace, [&](std::size_t i) { return lag_rad(trace, i); });
}

double max_tool_lag_rad(const Trace& trace) {
  return max(trace, [&](std::size_t i) { return lag_rad(trace, i); });
}

double guidance_fraction(const Trace& trace) {
  if (!trace.has_guidance() || trace.length() == 0) return kNoValue;
  double count = 0;
  for (const std::int32_t active : trace.guidance_active) count += active;
  return count / static_cast<double>(trace.length());
}

double guidance_error_m(const Trace& trace) {
  const auto i = last_guided_tick(trace);
  return i ? (trace.guidance_goal_m[*i] - trace.proxy_position_m[*i]).norm() : kNoValue;
}

double guidance_error_rad(const Trace& trace) {
  const auto i = last_guided_tick(trace);
  return i && trace.has_tool() ? angle_rad(trace.tool_orientation[*i], trace.guidance_orientation[*i])
                               : kNoValue;
}

}  // namespace remote_touch
