#include "analysis/measures/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/measures/contact_measures.h"
#include "analysis/measures/contact_point.h"
#include "analysis/measures/passivity_measures.h"

namespace remote_touch {

namespace {

// Share of the ticks for which the condition on the tick's number holds.
template <class Condition>
double share(const Trace& trace, Condition&& holds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) count += holds(i) ? 1 : 0;
  return trace.length() == 0 ? 0 : static_cast<double>(count) / static_cast<double>(trace.length());
}

constexpr Measure kMeasures[] = {
    {"popped_through", "1", "1 when the proxy's centre ended below the true surface", popped_through},
    {"largest_penetration", "m", "how far the centre was at most behind the true surface",
     largest_penetration_m},
    {"least_slave_distance", "m", "smallest distance of the slave's command to the true surface",
     least_slave_distance_m},
    {"rms_surface_error", "m", "rms distance between the rendered surface and the true one, in contact",
     rms_surface_error_m},
    {"largest_force_jump", "N", "largest change of the force at a frame update", largest_force_jump_N},
    {"largest_force", "N", "largest force", largest_force_N},
    {"mean_steps", "1", "proxy steps per tick", mean_steps},
    {"largest_steps", "1", "most proxy steps in a tick", largest_steps},
    {"unconverged_share", "1", "share of ticks that ended without convergence (4.8)", unconverged_share},
    {"non_finite_share", "1", "share of ticks with a number that is not finite", non_finite_share},
    {"mean_height", "m", "mean height of the rendered surface above the true one, in contact", mean_height_m},
    {"height_sd", "m", "standard deviation of that height", height_sd_m},
    {"mean_distance", "m", "mean distance of the centre to the true surface, while there is force",
     mean_distance_m},
    {"distance_sd", "m", "standard deviation of that distance", distance_sd_m},
    {"end_distance", "m", "distance of the centre to the true surface in the last tick", end_distance_m},
    {"force_share", "1", "share of ticks with a force", force_share},
    {"last_force_time", "s", "time of the last tick with a force", last_force_time_s},
    {"rms_force_jump", "N", "rms change of the force at a frame update", rms_force_jump_N},
    {"force_noise", "N", "rms change of the force from tick to tick, without an update", force_noise_N},
    {"energy_injected", "J", "work that the rendered force does on the hand", energy_injected_J},
    {"largest_energy_given", "J", "most work that the hand had got by any time", largest_energy_given_J},
    {"mean_energy_per_update", "J", "mean work on the hand from one frame update to the next, with force",
     mean_energy_per_update_J},
    {"largest_energy_per_update", "J", "the largest of it", largest_energy_per_update_J},
};

}  // namespace

std::span<const Measure> measures() {
  return kMeasures;
}

double popped_through(const Trace& trace) {
  return trace.length() > 0 && trace.signed_distance_m.back() < 0 ? 1 : 0;
}

double largest_penetration_m(const Trace& trace) {
  double deepest = std::numeric_limits<double>::quiet_NaN();
  for (const double distance : trace.signed_distance_m)
    if (!std::isnan(distance)) deepest = std::fmax(deepest, std::max(0.0, -distance));  // NaN loses
  return deepest;
}

double least_slave_distance_m(const Trace& trace) {
  double least = std::numeric_limits<double>::infinity();
  for (const double distance : trace.slave_distance_m) least = std::min(least, distance);  // NaN loses
  return std::isinf(least) ? std::numeric_limits<double>::quiet_NaN() : least;
}

double wrong_side_share(const Trace& trace) {
  std::size_t known = 0, wrong = 0;
  for (const double distance : trace.signed_distance_m) {
    if (std::isnan(distance)) continue;
    ++known;
    wrong += distance < 0 ? 1 : 0;
  }
  if (known == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(wrong) / static_cast<double>(known);
}

double rms_surface_error_m(const Trace& trace) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const double error = trace.signed_distance_m[i] - trace.nearest_m[i];
    if (trace.state[i] != static_cast<std::int32_t>(ContactState::contact) || !std::isfinite(error)) continue;
    squares += error * error;
    ++count;
  }
  if (count == 0)
    return std::numeric_limits<double>::quiet_NaN();  // not 0 / 0: its sign is the machine's choice
  return std::sqrt(squares / static_cast<double>(count));
}

double largest_force_jump_N(const Trace& trace) {
  double largest = 0;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (!trace.frame_update(i) || trace.force(i).isZero(0) || trace.force(i - 1).isZero(0)) continue;
    largest = std::max(largest, (trace.force(i) - trace.force(i - 1)).norm());
  }
  return largest;
}

double share_without_force(const Trace& trace, double contact_radius_m) {
  std::size_t pressed = 0, silent = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (!pressing(trace, i, contact_radius_m)) continue;
    ++pressed;
    silent += trace.force(i).isZero(0) ? 1 : 0;
  }
  return pressed == 0 ? 0 : static_cast<double>(silent) / static_cast<double>(pressed);
}

double mean_steps(const Trace& trace) {
  double sum = 0;
  for (const int steps : trace.proxy_steps) sum += steps;
  return trace.length() == 0 ? 0 : sum / static_cast<double>(trace.length());
}

double largest_steps(const Trace& trace) {
  return trace.length() == 0 ? 0 : *std::max_element(trace.proxy_steps.begin(), trace.proxy_steps.end());
}

double unconverged_share(const Trace& trace) {
  return share(trace, [&](std::size_t i) { return trace.converged[i] == 0; });
}

double non_finite_share(const Trace& trace) {
  return share(trace, [&](std::size_t i) {
    const bool tool = !trace.has_tool() ||
                      (trace.torque(i).allFinite() && trace.tool_orientation_at(i).coeffs().allFinite());
    const bool hand =
        !trace.has_hand() || (trace.device_force(i).allFinite() && trace.device_torque(i).allFinite());
    return !trace.proxy(i).allFinite() || !trace.force(i).allFinite() || !trace.normal_at(i).allFinite() ||
           !tool || !hand;
  });
}

double largest_force_N(const Trace& trace) {
  double largest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) largest = std::max(largest, trace.force(i).norm());
  return largest;
}

}  // namespace remote_touch
