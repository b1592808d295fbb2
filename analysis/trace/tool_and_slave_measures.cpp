#include "analysis/trace/tool_and_slave_measures.h"

#include <cmath>
#include <optional>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "core/points/vector.h"

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

namespace {

double rate_per_s(const Trace& trace, const std::vector<std::int32_t>& sent) {
  if (sent.size() < 2) return kNoValue;
  return (sent.back() - sent.front()) / (trace.time_s.back() - trace.time_s.front());
}

// Returns true if the scene may have exerted a force on the slave in tick i that is not known. Before the
// first command the clearance is not known either.
bool is_unknown_force(const Trace& trace, std::size_t i) {
  return std::isnan(trace.slave_peak_force_N[i]) && !std::isnan(trace.slave_clearance_m[i]);
}

bool has_unknown_force(const Trace& trace) {
  return first_tick(trace, [&](std::size_t i) { return is_unknown_force(trace, i); }) >= 0;
}

// The orientation that is sent to the slave's tool in tick i, see Teleoperation::command_orientation(). If
// the slave is sent where the device is, the renderer's tool is there too only while it touches nothing, and
// then it has the orientation of the device.
const Eigen::Quaterniond& commanded_orientation(const Trace& trace, std::size_t i) {
  return trace.slave_command_m[i] == trace.proxy_position_m[i] ? trace.tool_orientation[i]
                                                               : trace.hip_orientation[i];
}

}  // namespace

double max_slave_force_N(const Trace& trace) {
  if (has_unknown_force(trace)) return kNoValue;
  double largest = kNoValue;
  for (const double peak : trace.slave_peak_force_N) largest = std::fmax(largest, peak);  // ignores NaN
  return largest;
}

double slave_touched(const Trace& trace) {
  if (std::isnan(min_slave_clearance_m(trace))) return kNoValue;
  if (first_tick(trace, [&](std::size_t i) { return trace.slave_peak_force_N[i] > 0; }) >= 0) return 1;
  return has_unknown_force(trace) ? kNoValue : 0;
}

double slave_contact_fraction(const Trace& trace) {
  if (has_unknown_force(trace)) return kNoValue;
  return mean_where(
      trace.slave_peak_force_N.size(), [](std::size_t) { return true; },
      [&](std::size_t i) { return trace.slave_peak_force_N[i] > 0; });
}

double min_slave_clearance_m(const Trace& trace) {
  double least = kNoValue;
  for (const double clearance : trace.slave_clearance_m) least = std::fmin(least, clearance);  // ignores NaN
  return least;
}

double rms_slave_lag_m(const Trace& trace) {
  return std::sqrt(mean_where(
      trace.slave_position_m.size(), [&](std::size_t i) { return trace.slave_command_m[i].allFinite(); },
      [&](std::size_t i) { return (trace.slave_position_m[i] - trace.slave_command_m[i]).squaredNorm(); }));
}

double rms_slave_lag_angle_rad(const Trace& trace) {
  if (!trace.has_tool()) return kNoValue;
  return std::sqrt(mean_where(
      trace.slave_orientation.size(),
      [&](std::size_t i) {
        // A device without an orientation has a quaternion of zeros.
        const double norm = commanded_orientation(trace, i).norm();
        return trace.slave_command_m[i].allFinite() && norm > 0 && std::isfinite(norm);
      },
      [&](std::size_t i) {
        const Eigen::Quaterniond commanded = commanded_orientation(trace, i).normalized();
        return rotation_vector(commanded * trace.slave_orientation[i].conjugate()).squaredNorm();
      }));
}

double first_slave_contact_time_s(const Trace& trace) {
  const double tick = first_tick(
      trace, [&](std::size_t i) { return trace.slave_peak_force_N[i] > 0 || is_unknown_force(trace, i); });
  return tick >= 0 && is_unknown_force(trace, static_cast<std::size_t>(tick)) ? kNoValue
                                                                              : time_of(trace, tick);
}

double max_device_force_N(const Trace& trace) {
  return max_where(
      trace.device_force_N.size(), [](std::size_t) { return true; },
      [&](std::size_t i) { return trace.device_force_N[i].norm(); });
}

double slave_anticipation_s(const Trace& trace) {
  const auto is_felt = [&](std::size_t i) { return is_force(trace.device_force_N[i]); };
  return first_slave_contact_time_s(trace) - time_of(trace, first_tick(trace, is_felt));
}

double command_packet_rate_per_s(const Trace& trace) {
  return rate_per_s(trace, trace.command_packets);
}

double frame_packet_rate_per_s(const Trace& trace) {
  return rate_per_s(trace, trace.frame_packets);
}

double force_packet_rate_per_s(const Trace& trace) {
  return rate_per_s(trace, trace.force_packets);
}

}  // namespace remote_touch
