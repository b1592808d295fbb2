#include "analysis/trace/contact_measures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "core/points/number_columns.h"
#include "core/points/vector.h"

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

namespace {

// Height of the rendered surface above the true one.
double height_m(const Trace& trace, std::size_t i) {
  return trace.signed_distance_m[i] - trace.nearest_distance_m[i];
}

// Mean of value(height) over the ticks that end in contact, have a known truth and something near the proxy.
// NaN if a distance to the nearest point is unknown.
template <class Value>
double mean_in_contact(const Trace& trace, Value&& value) {
  const auto qualifies = [&](std::size_t i) {
    return trace.state[i] == static_cast<std::int32_t>(ContactState::contact) &&
           std::isfinite(trace.signed_distance_m[i]) && !std::isinf(trace.nearest_distance_m[i]);
  };
  return mean_where(trace.length(), qualifies, [&](std::size_t i) { return value(height_m(trace, i)); });
}

// Mean of value(distance) over the ticks with a force and a known truth. The distance is that of the centre
// from the true surface.
template <class Value>
double mean_with_force(const Trace& trace, Value&& value) {
  const auto qualifies = [&](std::size_t i) {
    return has_contact_force(trace, i) && std::isfinite(trace.signed_distance_m[i]);
  };
  return mean_where(trace.length(), qualifies,
                    [&](std::size_t i) { return value(trace.signed_distance_m[i]); });
}

double root(double mean_square) {
  return std::isnan(mean_square) ? kNoValue : std::sqrt(mean_square);
}

}  // namespace

double mean_height_m(const Trace& trace) {
  return mean_in_contact(trace, [](double height) { return height; });
}

double height_sd_m(const Trace& trace) {
  const double mean = mean_height_m(trace);
  return root(mean_in_contact(trace, [mean](double height) { return (height - mean) * (height - mean); }));
}

double rms_surface_error_m(const Trace& trace) {
  return root(mean_in_contact(trace, [](double height) { return height * height; }));
}

double mean_distance_m(const Trace& trace) {
  return mean_with_force(trace, [](double distance) { return distance; });
}

double distance_sd_m(const Trace& trace) {
  const double mean = mean_distance_m(trace);
  return root(mean_with_force(trace, [mean](double d) { return (d - mean) * (d - mean); }));
}

double end_distance_m(const Trace& trace) {
  return trace.length() == 0 ? kNoValue : trace.signed_distance_m.back();
}

double force_fraction(const Trace& trace) {
  double count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) count += has_contact_force(trace, i) ? 1 : 0;
  return trace.length() == 0 ? 0 : count / static_cast<double>(trace.length());
}

double last_force_time_s(const Trace& trace) {
  for (std::size_t i = trace.length(); i > 0; --i)
    if (has_contact_force(trace, i - 1)) return trace.time_s[i - 1];
  return kNoValue;
}

namespace {

// Tolerance for rounded times: without it a settling of 100 ticks could last 101 ticks.
constexpr double kSameTime_s = 5e-7;

// Calls act(i) for every settled tick.
template <class Act>
void for_each_settled(const Trace& trace, Act&& act) {
  double below_since_s = kNoValue;
  for (std::size_t i = 0; i < trace.contact.size(); ++i) {
    if (trace.frame_index[i] < 0 || !(trace.contact[i].hip_distance_m < 0)) {  // or NaN: not known
      below_since_s = kNoValue;
      continue;
    }
    if (std::isnan(below_since_s)) below_since_s = trace.time_s[i];
    if (trace.time_s[i] - below_since_s >= kSettling_s - kSameTime_s) act(i);
  }
}

// The maximum of value(height) over the settled ticks with a known truth.
template <class Value>
double max_of_heights(const Trace& trace, Value&& value) {
  double max = kNoValue;
  for_each_settled(trace, [&](std::size_t i) {
    const double height = trace.contact[i].height_m;
    if (!std::isnan(height)) max = std::isnan(max) ? value(height) : max_or_nan(max, value(height));
  });
  return max;
}

// Mean of value(contact) over the settled ticks in which it is not NaN; NaN if there is none.
template <class Value>
double settled_mean(const Trace& trace, Value&& value) {
  double sum = 0, count = 0;
  for_each_settled(trace, [&](std::size_t i) {
    const double here = value(trace.contact[i]);
    if (!std::isnan(here)) sum += here, ++count;
  });
  return count == 0 ? kNoValue : sum / count;
}

// Fraction of the settled ticks whose index satisfies the condition; NaN if no tick settled.
template <class Condition>
double settled_fraction(const Trace& trace, Condition&& holds) {
  double count = 0, all = 0;
  for_each_settled(trace, [&](std::size_t i) { count += holds(i) ? 1 : 0, ++all; });
  return all == 0 ? kNoValue : count / all;
}

}  // namespace

double max_contact_error_m(const Trace& trace) {
  return max_of_heights(trace, [](double height) { return std::abs(height); });
}

double max_sink_m(const Trace& trace) {
  return max_of_heights(trace, [](double height) { return std::max(0.0, -height); });  // no NaN
}

double max_float_m(const Trace& trace) {
  return max_of_heights(trace, [](double height) { return std::max(0.0, height); });  // no NaN
}

double rms_contact_error_m(const Trace& trace) {
  return std::sqrt(
      settled_mean(trace, [](const Trace::TrueContact& at) { return at.height_m * at.height_m; }));
}

double rms_renderer_error_m(const Trace& trace) {
  return std::sqrt(settled_mean(trace, [](const Trace::TrueContact& at) {
    return std::isnan(at.height_m) ? kNoValue : at.measured_height_m * at.measured_height_m;
  }));
}

double rms_camera_error_m(const Trace& trace) {
  return std::sqrt(settled_mean(trace, [](const Trace::TrueContact& at) {
    const double error_m = at.height_m - at.measured_height_m;
    return error_m * error_m;
  }));
}

double mean_camera_error_m(const Trace& trace) {
  return settled_mean(trace, [](const Trace::TrueContact& at) { return at.height_m - at.measured_height_m; });
}

double contact_force_fraction(const Trace& trace) {
  return settled_fraction(trace, [&](std::size_t i) { return has_contact_force(trace, i); });
}

double contact_known_fraction(const Trace& trace) {
  return settled_fraction(trace, [&](std::size_t i) { return !std::isnan(trace.contact[i].height_m); });
}

namespace {

// The force of a tick along the true normal, and its magnitude along the surface.
struct Parts {
  double along_normal_N = 0, lateral_N = 0;
};

std::vector<Parts> parts_in_contact(const Trace& trace) {
  std::vector<Parts> list;
  for (std::size_t i = 0; i < trace.true_normal.size(); ++i) {
    const Vec3& normal = trace.true_normal[i];
    const Vec3 force_N =
        trace.has_guidance() ? Vec3(trace.force_N[i] - trace.guidance_force_N[i]) : trace.force_N[i];
    const bool touches = trace.state[i] != static_cast<std::int32_t>(ContactState::free);
    if (!touches || !normal.allFinite() || !force_N.allFinite() || force_N.isZero(0)) continue;
    const double along_normal_N = force_N.dot(normal);
    list.push_back({along_normal_N, (force_N - along_normal_N * normal).norm()});
  }
  return list;
}

// The ratios of the ticks in which the force pushes out of the surface.
std::vector<double> lateral_ratios(const Trace& trace) {
  std::vector<double> ratios;
  for (const Parts& parts : parts_in_contact(trace)) {
    const double ratio = parts.lateral_N / parts.along_normal_N;
    if (parts.along_normal_N > 0 && std::isfinite(ratio)) ratios.push_back(ratio);
  }
  return ratios;
}

}  // namespace

double mean_lateral_force(const Trace& trace) {
  return mean(lateral_ratios(trace));
}

double lateral_force_95(const Trace& trace) {
  std::vector<double> ratios = lateral_ratios(trace);
  return ratios.empty() ? kNoValue : quantile_in_place(ratios, 0.95);
}

double mean_force_angle_rad(const Trace& trace) {
  std::vector<double> angles_rad;
  for (const Parts& parts : parts_in_contact(trace))
    angles_rad.push_back(std::atan2(parts.lateral_N, parts.along_normal_N));
  return mean(angles_rad);
}

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
