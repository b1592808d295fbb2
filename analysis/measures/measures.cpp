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
double fraction(const Trace& trace, Condition&& holds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) count += holds(i) ? 1 : 0;
  return trace.length() == 0 ? 0 : static_cast<double>(count) / static_cast<double>(trace.length());
}

constexpr Measure kMeasures[] = {
    {"popped_through", "1", "1 when the proxy's centre ended below the true surface", popped_through},
    {"max_penetration", "m", "maximum depth of the proxy's centre behind the true surface",
     max_penetration_m},
    {"min_slave_distance", "m", "minimum distance of the slave command to the true surface",
     min_slave_distance_m},
    {"rms_surface_error", "m", "rms distance between the rendered surface and the true one, in contact",
     rms_surface_error_m},
    {"max_force_jump", "N", "maximum change of the force at a frame update", max_force_jump_N},
    {"max_force", "N", "maximum force", max_force_N},
    {"mean_steps", "1", "mean number of proxy steps in a tick", mean_steps},
    {"max_steps", "1", "maximum number of proxy steps in a tick", max_steps},
    {"unconverged_fraction", "1", "fraction of ticks that ended without convergence (4.8)",
     unconverged_fraction},
    {"non_finite_fraction", "1", "fraction of ticks with a value that is not finite", non_finite_fraction},
    {"mean_height", "m", "mean height of the rendered surface above the true one, in contact", mean_height_m},
    {"height_sd", "m",
     "standard deviation of the height of the rendered surface above the true one, in contact", height_sd_m},
    {"mean_distance", "m", "mean distance of the proxy's centre to the true surface, while there is force",
     mean_distance_m},
    {"distance_sd", "m",
     "standard deviation of the distance of the centre to the true surface, while there is force",
     distance_sd_m},
    {"end_distance", "m", "distance of the proxy's centre to the true surface in the last tick",
     end_distance_m},
    {"force_fraction", "1", "fraction of ticks with a force", force_fraction},
    {"last_force_time", "s", "time of the last tick with a force", last_force_time_s},
    {"rms_force_jump", "N", "rms change of the force at a frame update", rms_force_jump_N},
    {"force_noise", "N", "rms change of the force from tick to tick, without an update", force_noise_N},
    {"energy_injected", "J", "work of the rendered force on the hand", energy_injected_J},
    {"max_energy_injected", "J", "maximum over time of the energy injected into the hand",
     max_energy_injected_J},
    {"mean_energy_per_update", "J", "mean work on the hand from one frame update to the next, with force",
     mean_energy_per_update_J},
    {"max_energy_per_update", "J", "maximum work on the hand from one frame update to the next, with force",
     max_energy_per_update_J},
};

}  // namespace

std::span<const Measure> measures() {
  return kMeasures;
}

double popped_through(const Trace& trace) {
  return trace.length() > 0 && trace.signed_distance_m.back() < 0 ? 1 : 0;
}

double max_penetration_m(const Trace& trace) {
  double deepest = std::numeric_limits<double>::quiet_NaN();
  for (const double distance : trace.signed_distance_m)
    if (!std::isnan(distance)) deepest = std::fmax(deepest, std::max(0.0, -distance));  // NaN loses
  return deepest;
}

double min_slave_distance_m(const Trace& trace) {
  double min = std::numeric_limits<double>::infinity();
  for (const double distance : trace.slave_distance_m) min = std::min(min, distance);  // NaN loses
  return std::isinf(min) ? std::numeric_limits<double>::quiet_NaN() : min;
}

double wrong_side_fraction(const Trace& trace) {
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
    const double error = trace.signed_distance_m[i] - trace.nearest_distance_m[i];
    if (trace.state[i] != static_cast<std::int32_t>(ContactState::contact) || !std::isfinite(error)) continue;
    squares += error * error;
    ++count;
  }
  if (count == 0)
    return std::numeric_limits<double>::quiet_NaN();  // not 0 / 0: its sign is the machine's choice
  return std::sqrt(squares / static_cast<double>(count));
}

double max_force_jump_N(const Trace& trace) {
  double max = 0;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (!trace.frame_update(i) || trace.force_N[i].isZero(0) || trace.force_N[i - 1].isZero(0)) continue;
    max = std::max(max, (trace.force_N[i] - trace.force_N[i - 1]).norm());
  }
  return max;
}

double no_force_fraction(const Trace& trace, double contact_radius_m) {
  std::size_t pressed = 0, silent = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (!pressing(trace, i, contact_radius_m)) continue;
    ++pressed;
    silent += trace.force_N[i].isZero(0) ? 1 : 0;
  }
  return pressed == 0 ? 0 : static_cast<double>(silent) / static_cast<double>(pressed);
}

double mean_steps(const Trace& trace) {
  double sum = 0;
  for (const int steps : trace.proxy_steps) sum += steps;
  return trace.length() == 0 ? 0 : sum / static_cast<double>(trace.length());
}

double max_steps(const Trace& trace) {
  return trace.length() == 0 ? 0 : *std::max_element(trace.proxy_steps.begin(), trace.proxy_steps.end());
}

double unconverged_fraction(const Trace& trace) {
  return fraction(trace, [&](std::size_t i) { return trace.converged[i] == 0; });
}

double non_finite_fraction(const Trace& trace) {
  return fraction(trace, [&](std::size_t i) {
    const bool tool = !trace.has_tool() ||
                      (trace.torque_Nm[i].allFinite() && trace.tool_orientation[i].coeffs().allFinite());
    const bool hand =
        !trace.has_hand() || (trace.device_force_N[i].allFinite() && trace.device_torque_Nm[i].allFinite());
    return !trace.proxy_position_m[i].allFinite() || !trace.force_N[i].allFinite() ||
           !trace.normal[i].allFinite() || !tool || !hand;
  });
}

double max_force_N(const Trace& trace) {
  double max = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) max = std::max(max, trace.force_N[i].norm());
  return max;
}

}  // namespace remote_touch
