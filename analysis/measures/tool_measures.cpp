#include "analysis/measures/tool_measures.h"

#include <cmath>
#include <optional>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

double angle_rad(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return rotation_vector(to * from.conjugate()).norm();
}

std::optional<std::size_t> last_guided_tick(const Trace& trace) {
  for (std::size_t i = trace.guidance_active.size(); i > 0; --i)
    if (trace.guidance_active[i - 1] != 0) return i - 1;
  return std::nullopt;
}

}  // namespace

double tool_lag_m(const Trace& trace, std::size_t i) {
  return (trace.hip_position_m[i] - trace.proxy_position_m[i]).norm();
}

double tool_lag_rad(const Trace& trace, std::size_t i) {
  return angle_rad(trace.tool_orientation[i], trace.hip_orientation[i]);
}

double torque_magnitude_Nm(const Trace& trace, std::size_t i) {
  return trace.torque_Nm[i].norm();
}

double min_clearance_m(const Trace& trace) {
  if (!trace.has_tool()) return kNoValue;
  const double found = min_of(trace.nearest_distance_m);
  return std::isinf(found) ? kNoValue : found;
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
