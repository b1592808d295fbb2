#include "analysis/trace/force_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

// A tick that belongs to the press or to the release, with the tick before it.
struct Pressed {
  double before_m = 0, depth_m = 0;   // indentation
  double before_N = 0, normal_N = 0;  // normal force
  double stretch_m = 0;               // height of the contact point above the HIP
  bool deeper() const { return depth_m > before_m; }
};

// Returns NaN if the true normal is not known.
double normal_force_N(const Trace& trace, std::size_t i) {
  const Vec3 force_N = contact_force_N(trace, i);
  return force_N.isZero(0) ? 0 : force_N.dot(trace.true_normal[i]);
}

std::vector<Pressed> pressed_ticks(const Trace& trace, bool deeper) {
  std::vector<Pressed> ticks;
  for (std::size_t i = 1; i < std::min(trace.contact.size(), trace.true_normal.size()); ++i) {
    const Trace::TrueContact &before = trace.contact[i - 1], &now = trace.contact[i];
    const Pressed tick{-before.hip_distance_m, -now.hip_distance_m, normal_force_N(trace, i - 1),
                       normal_force_N(trace, i), now.height_m - now.hip_distance_m};
    const bool is_known = std::isfinite(tick.before_m) && std::isfinite(tick.before_N) &&
                          std::isfinite(tick.normal_N) && std::isfinite(tick.stretch_m);
    const double least_m = kPressing_m_per_s * (trace.time_s[i] - trace.time_s[i - 1]);
    const bool moves = std::abs(tick.depth_m - tick.before_m) >= least_m;
    if (is_known && moves && tick.depth_m > 0 && tick.before_m > 0 && tick.deeper() == deeper)
      ticks.push_back(tick);
  }
  return ticks;
}

// A line y = mean_y + slope (x - mean_x).
struct Line {
  double slope = kNoValue, mean_x = 0, mean_y = 0;
};

// Returns the line of least squares of the normal force over a member of the ticks.
Line line_of(const std::vector<Pressed>& ticks, double Pressed::*over) {
  Line line;
  const auto count = static_cast<double>(ticks.size());
  for (const Pressed& tick : ticks) line.mean_x += tick.*over / count, line.mean_y += tick.normal_N / count;
  double xx = 0, xy = 0;
  for (const Pressed& tick : ticks) {
    const double x = tick.*over - line.mean_x;
    xx += x * x, xy += x * (tick.normal_N - line.mean_y);
  }
  if (xx > 0) line.slope = xy / xx;
  return line;
}

// The smallest and the largest indentation of the ticks, m.
struct Range {
  double low = 0, high = 0;
  bool is_long_enough() const { return high - low >= kMinIndentation_m; }
};
Range range_of(const std::vector<Pressed>& ticks) {
  if (ticks.empty()) return {};
  Range range{ticks.front().depth_m, ticks.front().depth_m};
  for (const Pressed& tick : ticks) {
    range.low = std::min({range.low, tick.before_m, tick.depth_m});    // no NaN
    range.high = std::max({range.high, tick.before_m, tick.depth_m});  // no NaN
  }
  return range;
}

// Returns no ticks if the press is too short to have a stiffness, or if no force of it pushes out.
std::vector<Pressed> press_of(const Trace& trace) {
  std::vector<Pressed> press = pressed_ticks(trace, true);
  const bool pushes = std::ranges::any_of(press, [](const Pressed& tick) { return tick.normal_N > 0; });
  if (!pushes || !range_of(press).is_long_enough()) press.clear();
  return press;
}

// Mean of the normal force over the indentation, within the range.
double mean_force_N(const std::vector<Pressed>& ticks, const Range& range) {
  double work_J = 0, length_m = 0;
  for (const Pressed& tick : ticks) {
    const double low = std::max(range.low, std::min(tick.before_m, tick.depth_m));    // no NaN
    const double high = std::min(range.high, std::max(tick.before_m, tick.depth_m));  // no NaN
    if (!(high > low)) continue;
    const double slope = (tick.normal_N - tick.before_N) / (tick.depth_m - tick.before_m);
    work_J += (high - low) * (tick.before_N + slope * (0.5 * (low + high) - tick.before_m));
    length_m += high - low;
  }
  return length_m > 0 ? work_J / length_m : kNoValue;
}

}  // namespace

double rendered_stiffness_N_per_m(const Trace& trace) {
  return line_of(press_of(trace), &Pressed::depth_m).slope;
}

double stiffness_error(const Trace& trace) {
  const std::vector<Pressed> press = press_of(trace);
  const double coupling = line_of(press, &Pressed::stretch_m).slope;
  return coupling > 0 ? line_of(press, &Pressed::depth_m).slope / coupling - 1 : kNoValue;
}

double stiffness_nonlinearity(const Trace& trace) {
  const std::vector<Pressed> press = press_of(trace);
  const Line line = line_of(press, &Pressed::depth_m);
  double squares = 0, largest_N = 0;
  for (const Pressed& tick : press) {
    const double rest_N = tick.normal_N - line.mean_y - line.slope * (tick.depth_m - line.mean_x);
    squares += rest_N * rest_N;
    largest_N = std::max(largest_N, tick.normal_N);  // no NaN
  }
  return largest_N > 0 ? std::sqrt(squares / static_cast<double>(press.size())) / largest_N : kNoValue;
}

double stiffness_hysteresis(const Trace& trace) {
  const std::vector<Pressed> press = press_of(trace), release = pressed_ticks(trace, false);
  const Range down = range_of(press), up = range_of(release);
  const Range both{std::max(down.low, up.low), std::min(down.high, up.high)};  // no NaN
  if (press.empty() || release.empty() || !both.is_long_enough()) return kNoValue;
  const double press_N = mean_force_N(press, both);
  return press_N > 0 ? 1 - mean_force_N(release, both) / press_N : kNoValue;
}

namespace {

// False for an unknown force.
bool is_contact(const Vec3& force_N) {
  return force_N.norm() > kContactForce_N;
}
bool is_expected(const Vec3& expected_N) {
  return expected_N.norm() > kExpectedContact_N;
}

// Mean of value(expected force, rendered force) over the ticks for which qualifies() of the same two is true
// and the expected force is known.
template <class Qualifies, class Value>
double mean_of_replay(const Trace& trace, Qualifies&& qualifies, Value&& value) {
  return mean_where(
      trace.expected_force_N.size(),
      [&](std::size_t i) {
        const Vec3& expected_N = trace.expected_force_N[i];
        return expected_N.allFinite() && qualifies(expected_N, contact_force_N(trace, i));
      },
      [&](std::size_t i) { return value(trace.expected_force_N[i], contact_force_N(trace, i)); });
}

bool always(const Vec3&, const Vec3&) {
  return true;
}

double mean_square_error(const Trace& trace) {
  return mean_of_replay(trace, always, [](const Vec3& expected, const Vec3& force) {
    return (force - expected).squaredNorm();
  });
}

}  // namespace

double rms_force_error_N(const Trace& trace) {
  const double error = mean_square_error(trace);
  return std::isnan(error) ? kNoValue : std::sqrt(error);
}

double relative_force_error(const Trace& trace) {
  const double error = mean_square_error(trace);
  const double square =
      mean_of_replay(trace, always, [](const Vec3& expected, const Vec3&) { return expected.squaredNorm(); });
  return std::isnan(error) || !(square > 0) ? kNoValue : std::sqrt(error / square);
}

double force_direction_error_rad(const Trace& trace) {
  return mean_of_replay(
      trace,
      [](const Vec3& expected, const Vec3& force) { return is_expected(expected) && is_contact(force); },
      [](const Vec3& expected, const Vec3& force) {
        return std::atan2(expected.cross(force).norm(), expected.dot(force));
      });
}

double false_contact_fraction(const Trace& trace) {
  return mean_of_replay(
      trace, [](const Vec3& expected, const Vec3&) { return expected.isZero(0); },
      [](const Vec3&, const Vec3& force) { return force.allFinite() ? is_contact(force) : kNoValue; });
}

double lost_contact_fraction(const Trace& trace) {
  return mean_of_replay(
      trace, [](const Vec3& expected, const Vec3&) { return is_expected(expected); },
      [](const Vec3&, const Vec3& force) { return !is_contact(force); });
}

namespace {

// Work that the device does on the hand from tick i to tick i + 1.
double work_J(const Trace& trace, std::size_t i) {
  const auto& position_m = trace.has_rounded_hand() ? trace.hand_position_m : trace.hip_position_m;
  const Vec3& force_N = trace.has_hand() ? trace.device_force_N[i] : trace.force_N[i];
  const double by_force = force_N.dot(position_m[i + 1] - position_m[i]);
  if (!trace.has_tool()) return by_force;
  const auto& orientation = trace.has_rounded_hand() ? trace.hand_orientation : trace.hip_orientation;
  const Vec3& torque_Nm = trace.has_hand() ? trace.device_torque_Nm[i] : trace.torque_Nm[i];
  return by_force + torque_Nm.dot(rotation_vector(orientation[i + 1] * orientation[i].conjugate()));
}

// True if the hand feels a wrench in tick i. It feels no command for which the device has no motor.
bool has_wrench(const Trace& trace, std::size_t i) {
  if (trace.has_hand())
    return !trace.device_force_N[i].isZero(0) || (trace.has_tool() && !trace.device_torque_Nm[i].isZero(0));
  return !trace.force_N[i].isZero(0) || (trace.has_tool() && !trace.torque_Nm[i].isZero(0));
}

// The work from each frame update to the next one, if the hand feels a force or a torque in between.
std::vector<double> work_between_updates_J(const Trace& trace) {
  std::vector<double> pieces;
  double work = 0;
  bool begun = false, felt = false;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.frame_update(i)) {
      if (begun && felt) pieces.push_back(work);
      work = 0, begun = true, felt = false;
    }
    felt |= has_wrench(trace, i);
    if (i + 1 < trace.length()) work += work_J(trace, i);
  }
  return pieces;
}

}  // namespace

double energy_injected_J(const Trace& trace) {
  double given = 0;
  for (std::size_t i = 0; i + 1 < trace.length(); ++i) given += work_J(trace, i);
  return given;
}

double max_energy_injected_J(const Trace& trace) {
  double given = 0, max = 0;
  for (std::size_t i = 0; i + 1 < trace.length(); ++i) {
    given += work_J(trace, i);
    max = max_or_nan(max, given);
  }
  return max;
}

double mean_energy_per_update_J(const Trace& trace) {
  return mean(work_between_updates_J(trace));
}

double max_energy_per_update_J(const Trace& trace) {
  const std::vector<double> pieces = work_between_updates_J(trace);
  return max_of(pieces);
}

double min_channel_energy_J(const Trace& trace) {
  if (!trace.has_channel_energy()) return kNoValue;
  double lowest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    lowest = min_or_nan(lowest, trace.hand_energy_in_J[i] - trace.hand_energy_out_J[i] +
                                    trace.slave_energy_in_J[i] - trace.slave_energy_out_J[i]);
  return lowest;
}

double dissipated_energy_J(const Trace& trace) {
  return trace.has_channel_energy() ? trace.dissipated_energy_J.back() : kNoValue;
}

}  // namespace remote_touch
