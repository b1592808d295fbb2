#include "analysis/trace/measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/force_measures.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

Better direction_of(const Directions& directions, const std::string& measure) {
  const auto found = directions.find(measure);
  return found == directions.end() ? Better::neither : found->second;
}

bool is_outcome(const std::string& measure) {
  return measure == "popped_through" || measure == "tool_popped_through" || measure == "non_finite_fraction";
}

const char* text_of(Better better) {
  constexpr const char* kTexts[] = {"has no direction", "smaller is better", "larger is better",
                                    "nearer to zero is better",
                                    "larger is better up to 0; all values from 0 on are equally good"};
  return kTexts[static_cast<int>(better)];
}

double badness(double value, Better better) {
  switch (better) {
    case Better::larger:
      return -value;
    case Better::near_zero:
      return std::abs(value);
    case Better::not_negative:
      return value >= 0 ? 0 : -value;  // NaN stays NaN
    case Better::neither:
    case Better::smaller:
      break;
  }
  return value;
}

bool is_change(Judgement judgement) {
  return judgement == Judgement::better || judgement == Judgement::worse || judgement == Judgement::changed;
}

const char* name_of(Judgement judgement) {
  constexpr const char* kNames[] = {"equal", "within_margin", "better", "worse", "changed", "undecided"};
  return kNames[static_cast<int>(judgement)];
}

bool needs_contact(const std::string& measure) {
  constexpr const char* kOthers[] = {"guidance_",
                                     "rms_slave_",
                                     "slave_anticipation",
                                     "rms_force_error",
                                     "relative_force_error",
                                     "force_direction_error",
                                     "false_contact_fraction",
                                     "lost_contact_fraction"};
  return !is_outcome(measure) &&
         std::ranges::none_of(kOthers, [&](const char* other) { return measure.starts_with(other); });
}

Judgement judge_value(double baseline, double candidate, Better better, const Tolerance& tolerance) {
  if (within(tolerance, baseline, candidate)) return Judgement::equal;
  // A difference that may be rounding has no direction.
  constexpr double kRounding = 1e-9;
  const double most = max_or_nan(std::abs(baseline), std::abs(candidate));
  if (std::isfinite(most) && std::abs(candidate - baseline) <= kRounding * most) return Judgement::changed;
  const double before = badness(baseline, better), now = badness(candidate, better);
  if (better == Better::neither || std::isnan(before) || std::isnan(now) || before == now)
    return Judgement::changed;
  return now < before ? Judgement::better : Judgement::worse;
}

namespace {

// Fraction of the ticks i for which holds(i) is true; 0 for a trace without ticks.
template <class Condition>
double fraction(const Trace& trace, Condition&& holds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) count += holds(i) ? 1 : 0;
  return trace.length() == 0 ? 0 : static_cast<double>(count) / static_cast<double>(trace.length());
}

// True if the renderer had a frame in tick i and the distance to the true surface is known.
bool is_judged(const Trace& trace, std::size_t i) {
  return trace.frame_index[i] >= 0 && !std::isnan(trace.signed_distance_m[i]);
}

using enum MeasuredRuns;
using enum Better;

// Same data as Measure, but a compile-time constant: it needs no initialisation at program start.
struct Row {
  const char *name, *unit, *meaning;
  MeasuredRuns runs;
  Better better;
  double (*compute)(const Trace&);
};

// A force, its work, a count of contacts or a time is neither good nor bad by itself: a proxy that holds a
// rising surface pushes harder than one that lets it pass.
constexpr Row kMeasures[] = {
    {"popped_through", "1",
     "1 when the proxy passed through the true surface (or the measured one, if that is known) and ended "
     "behind it",
     proxy, smaller, popped_through},
    {"max_penetration", "m", "maximum depth of the proxy's centre behind the true surface", proxy, smaller,
     max_penetration_m},
    {"min_slave_distance", "m", "minimum distance of the slave command to the true surface", all,
     not_negative, min_slave_distance_m},
    {"rms_surface_error", "m", "rms distance between the rendered surface and the true one, in contact",
     proxy, smaller, rms_surface_error_m},
    {"max_force_jump", "N", "maximum change of the force at a frame update", all, smaller, max_force_jump_N},
    {"max_force", "N", "maximum force", all, neither, max_force_N},
    {"mean_steps", "1", "mean number of proxy steps in a tick", all, neither, mean_steps},
    {"max_steps", "1", "maximum number of proxy steps in a tick", all, neither, max_steps},
    {"unconverged_fraction", "1", "fraction of ticks that ended without convergence (4.8)", proxy, smaller,
     unconverged_fraction},
    {"non_finite_fraction", "1", "fraction of ticks with a value that is not finite", all, smaller,
     non_finite_fraction},
    {"mean_height", "m", "mean height of the rendered surface above the true one, in contact", proxy,
     near_zero, mean_height_m},
    {"height_sd", "m",
     "standard deviation of the height of the rendered surface above the true one, in contact", proxy,
     smaller, height_sd_m},
    {"mean_distance", "m", "mean distance of the proxy's centre to the true surface, while there is force",
     proxy, neither, mean_distance_m},
    {"distance_sd", "m",
     "standard deviation of the distance of the centre to the true surface, while there is force", proxy,
     smaller, distance_sd_m},
    {"end_distance", "m", "distance of the proxy's centre to the true surface in the last tick", proxy,
     neither, end_distance_m},
    {"force_fraction", "1", "fraction of ticks with a force", all, neither, force_fraction},
    {"last_force_time", "s", "time of the last tick with a force", all, neither, last_force_time_s},
    {"rms_force_jump", "N", "rms change of the force at a frame update with a force", all, smaller,
     rms_force_jump_N},
    {"force_noise", "N", "rms change of the force from tick to tick, with a force, without an update", all,
     smaller, force_noise_N},
    {"energy_injected", "J", "work of the device on the hand, by force and torque", all, neither,
     energy_injected_J},
    {"max_energy_injected", "J", "maximum over time of the energy injected into the hand", all, neither,
     max_energy_injected_J},
    {"mean_energy_per_update", "J", "mean work on the hand from one frame update to the next, with force",
     all, neither, mean_energy_per_update_J},
    {"max_energy_per_update", "J", "maximum work on the hand from one frame update to the next, with force",
     all, neither, max_energy_per_update_J},
    {"first_contact_time", "s", "time of the first tick with a contact", all, neither, first_contact_time_s},
    {"first_contact_tick", "1", "number of the first tick with a contact, from 0", all, neither,
     first_contact_tick},
    {"first_pop_through_time", "s",
     "time of the first tick in which the proxy or tool passes through the true surface", all, neither,
     first_pop_through_time_s},
    {"first_pop_through_tick", "1",
     "number of the first tick in which the proxy or tool passes through the true surface, from 0", all,
     neither, first_pop_through_tick},
    {"max_force_jump_time", "s", "time of the maximum change of the force at a frame update", all, neither,
     max_force_jump_time_s},
    {"max_force_jump_tick", "1", "number of the tick with the maximum change of the force at a frame update",
     all, neither, max_force_jump_tick},

    {"max_contact_error", "m",
     "maximum distance of the contact point from the true surface, above or below it, in settled ticks",
     contact, smaller, max_contact_error_m},
    {"max_sink", "m", "maximum depth of the contact point below the true surface, in settled ticks", contact,
     smaller, max_sink_m},
    {"max_float", "m", "maximum height of the contact point above the true surface, in settled ticks",
     contact, smaller, max_float_m},
    {"rms_contact_error", "m", "rms distance of the contact point from the true surface, in settled ticks",
     contact, smaller, rms_contact_error_m},
    {"contact_force_fraction", "1", "fraction of the settled ticks with a force", contact, larger,
     contact_force_fraction},
    {"contact_known_fraction", "1", "fraction of the settled ticks with a known truth", contact, neither,
     contact_known_fraction},
    // The measure has no direction: a renderer that follows a bad measurement exactly is not better, and a
    // filter that corrects the measurement is not worse. rms_contact_error judges both by the truth.
    {"rms_renderer_error", "m",
     "rms distance of the contact point from the measured surface, in settled ticks", measured_surface,
     neither, rms_renderer_error_m},
    {"rms_camera_error", "m",
     "rms distance between the measured and the true surface at the contact point, in settled ticks",
     measured_surface, neither, rms_camera_error_m},
    {"mean_camera_error", "m",
     "mean height of the measured surface above the true one at the contact point, in settled ticks",
     measured_surface, neither, mean_camera_error_m},
    {"popped_through_truth", "1",
     "1 when the proxy passed through the true surface and ended behind it, by its own fault or the camera's",
     measured_surface, neither,
     [](const Trace& trace) {
       return trace.has_measured_surface() ? side_of_run(trace, trace.signed_distance_m).popped_through
                                           : kNoValue;
     }},
    {"mean_lateral_force", "1",
     "mean ratio of the force along the true surface to the force along its normal, "
     "in contact while the force pushes out of it",
     true_normal, smaller, mean_lateral_force},
    {"lateral_force_95", "1",
     "95th percentile of the ratio of the force along the true surface to that along its normal, "
     "in contact while the force pushes out of it",
     true_normal, smaller, lateral_force_95},
    {"mean_force_angle", "rad", "mean angle between the force and the normal of the true surface, in contact",
     true_normal, smaller, mean_force_angle_rad},
    {"jump_fraction_5", "1",
     "fraction of the frame updates with a force at which the force changes by more than 5 %", all, smaller,
     [](const Trace& trace) { return felt_jump_fraction(trace, 0.05); }},
    {"jump_fraction_10", "1",
     "fraction of the frame updates with a force at which the force changes by more than 10 %", all, smaller,
     [](const Trace& trace) { return felt_jump_fraction(trace, 0.1); }},
    {"jump_fraction_20", "1",
     "fraction of the frame updates with a force at which the force changes by more than 20 %", all, smaller,
     [](const Trace& trace) { return felt_jump_fraction(trace, 0.2); }},
    {"packet_rate_5", "1/s", "packets per second of the force with a dead-band of 5 %, IEEE 1918.1.1", all,
     neither, [](const Trace& trace) { return deadband_packets_per_s(trace, 0.05); }},
    {"packet_rate_10", "1/s", "packets per second of the force with a dead-band of 10 %, IEEE 1918.1.1", all,
     neither, [](const Trace& trace) { return deadband_packets_per_s(trace, 0.1); }},
    {"packet_rate_20", "1/s", "packets per second of the force with a dead-band of 20 %, IEEE 1918.1.1", all,
     neither, [](const Trace& trace) { return deadband_packets_per_s(trace, 0.2); }},
    {"max_relative_jump", "1",
     "maximum change of the force at a frame update as a fraction of the force before it, from 0.1 N on", all,
     smaller, max_relative_jump},
    {"max_relative_change", "1",
     "maximum change of the force from tick to tick as a fraction of the force before it, from 0.1 N on, "
     "without an update",
     all, smaller, max_relative_change},
    {"apparent_friction", "1",
     "ratio of the force against the direction of sliding to the force along the normal of the true surface",
     true_normal, near_zero, apparent_friction},
    {"force_overshoot", "1",
     "maximum force of a contact above its final force, as a fraction of that, if the force is steady at the end",
     all, smaller, force_overshoot},
    {"force_settling_time", "s",
     "time from the first force until it stays within 5 % of its final value, if it is steady at the end",
     all, smaller, force_settling_time_s},
    {"force_ripple", "N", "rms difference of the force from its mean over 100 ms, while there is force", all,
     smaller, force_ripple_N},
    {"relative_ripple", "1",
     "rms difference of the force from its mean over 100 ms, divided by the mean force", all, smaller,
     relative_ripple},
    {"rendered_stiffness", "N/m",
     "slope of the force along the normal of the true surface over the depth of the HIP, during a press "
     "below that surface, also before the force begins",
     contact, neither, rendered_stiffness_N_per_m},
    {"stiffness_error", "1",
     "rendered stiffness divided by the slope of the same forces over the stretch of the virtual coupling, "
     "minus 1",
     contact, near_zero, stiffness_error},
    {"stiffness_nonlinearity", "1",
     "rms distance of the force of a press from its line over the depth, divided by its maximum", contact,
     smaller, stiffness_nonlinearity},
    {"stiffness_hysteresis", "1", "part of the work of a press that the release does not give back", contact,
     near_zero, stiffness_hysteresis},
    {"rms_force_error", "N", "rms difference of the force from the expected force", replay, smaller,
     rms_force_error_N},
    {"relative_force_error", "1",
     "rms difference of the force from the expected force, divided by the rms expected force", replay,
     smaller, relative_force_error},
    {"force_direction_error", "rad",
     "mean angle between the force and the expected force, where both are felt", replay, smaller,
     force_direction_error_rad},
    {"false_contact_fraction", "1",
     "fraction of the ticks without an expected force in which there is a force", replay, smaller,
     false_contact_fraction},
    {"lost_contact_fraction", "1", "fraction of the ticks with an expected force in which there is no force",
     replay, smaller, lost_contact_fraction},

    {"tool_popped_through", "1",
     "1 when the tool's centre of mass passed through the true surface and ended behind it", tool, smaller,
     [](const Trace& trace) { return trace.has_tool() ? popped_through(trace) : kNoValue; }},
    {"max_torque", "N m", "maximum torque about the HIP", tool, neither, tool_max<torque_magnitude_Nm>},
    {"max_torque_jump", "N m", "maximum change of the torque at a frame update", tool, smaller,
     max_torque_jump_Nm},
    {"rms_torque_jump", "N m", "rms change of the torque at a frame update with a torque", tool, smaller,
     rms_torque_jump_Nm},
    {"torque_noise", "N m", "rms change of the torque from tick to tick, with a torque, without an update",
     tool, smaller, torque_noise_Nm},
    {"mean_contact_count", "1", "mean number of contacts of the tool", tool, neither,
     tool_mean<&Trace::contact_count>},
    {"max_contact_count", "1", "maximum number of contacts of the tool", tool, neither,
     tool_max<&Trace::contact_count>},
    {"mean_active_constraints", "1", "mean number of active constraints of (6.5)", tool, neither,
     tool_mean<&Trace::active_constraints>},
    {"max_active_constraints", "1", "maximum number of active constraints of (6.5)", tool, neither,
     tool_max<&Trace::active_constraints>},
    {"max_contact_clusters", "1", "maximum number of groups of touching points", tool, neither,
     tool_max<&Trace::contact_clusters>},
    {"max_tool_penetration", "m", "maximum depth of a point of the newest frame in the tool", tool, smaller,
     tool_max<&Trace::tool_penetration_m>},
    {"min_clearance", "m", "minimum gap between the tool and the nearest point or region, negative inside it",
     tool, not_negative, min_clearance_m},
    {"mean_detections", "1", "mean number of collision detections in a tick", tool, smaller,
     tool_mean<&Trace::detections>},
    {"max_detections", "1", "maximum number of collision detections in a tick", tool, smaller,
     tool_max<&Trace::detections>},
    {"exhausted_fraction", "1", "fraction of ticks that ended before the tool had converged", tool, smaller,
     tool_mean<&Trace::budget_exhausted>},
    {"mean_tool_lag", "m", "mean distance of the tool's centre of mass from the HIP", tool, neither,
     tool_mean<tool_lag_m>},
    {"max_tool_lag", "m", "maximum distance of the tool's centre of mass from the HIP", tool, neither,
     tool_max<tool_lag_m>},
    {"mean_tool_lag_angle", "rad", "mean angle between tool and device", tool, neither,
     tool_mean<tool_lag_rad>},
    {"max_tool_lag_angle", "rad", "maximum angle between tool and device", tool, neither,
     tool_max<tool_lag_rad>},

    {"max_slave_force", "N", "maximum force of the scene on the slave", slave, neither, max_slave_force_N},
    {"slave_touched", "1", "1 when the scene exerted a force on the slave in any tick", slave, neither,
     slave_touched},
    {"slave_contact_fraction", "1", "fraction of ticks with a force on the slave", slave, neither,
     slave_contact_fraction},
    {"min_slave_clearance", "m", "minimum distance of the slave's ball or tool from the true surface", slave,
     neither, min_slave_clearance_m},
    {"rms_slave_lag", "m", "rms distance of the slave from the commanded position at that time", slave,
     smaller, rms_slave_lag_m},
    {"rms_slave_lag_angle", "rad",
     "rms angle between the slave's tool and the orientation commanded at that time", slave, smaller,
     rms_slave_lag_angle_rad},
    {"first_slave_contact_time", "s", "time of the first tick with a force on the slave", slave, neither,
     first_slave_contact_time_s},
    {"slave_anticipation", "s", "time by which the hand feels a force before the slave does", slave, larger,
     slave_anticipation_s},
    {"command_packet_rate", "1/s",
     "number of commands sent after the first tick, divided by the time from it to the last", slave, neither,
     command_packet_rate_per_s},
    {"force_packet_rate", "1/s",
     "number of forces sent after the first tick, divided by the time from it to the last", slave, neither,
     force_packet_rate_per_s},
    {"max_device_force", "N", "maximum force of the device on the hand", slave, neither, max_device_force_N},
    {"min_channel_energy", "J",
     "lowest energy of the channel between hand and slave; negative: it gave more than it received", slave,
     neither, min_channel_energy_J},
    {"dissipated_energy", "J", "energy that passivity control has kept from leaving this channel", slave,
     neither, dissipated_energy_J},
    {"frame_packet_rate", "1/s",
     "number of frames that arrived after the first tick, divided by the time from it to the last", slave,
     neither, frame_packet_rate_per_s},

    {"guidance_fraction", "1", "fraction of ticks with active guidance to a visible target", guidance,
     neither, guidance_fraction},
    {"guidance_error", "m", "distance of tool or proxy from the goal at the last tick with guidance",
     guidance, smaller, guidance_error_m},
    {"guidance_error_angle", "rad", "angle between tool and goal at the last tick with guidance", guidance,
     smaller, guidance_error_rad},
};

}  // namespace

const std::vector<Measure>& built_in_measures() {
  static const std::vector<Measure> all = [] {
    std::vector<Measure> made;
    for (const Row& row : kMeasures)
      made.push_back({row.name, row.unit, row.meaning, row.runs,
                      [compute = row.compute](const Trace& trace) {
                        const double value = compute(trace);
                        return std::isnan(value) ? kNoValue : value;  // a NaN of one sign
                      },
                      row.better});
    return made;
  }();
  return all;
}

const char* name_of(MeasuredRuns runs) {
  switch (runs) {
    case proxy:
    case contact:
      return "runs without a tool";
    case tool:
      return "runs with a tool";
    case guidance:
      return "runs with guidance";
    case true_normal:
      return "runs with a known true normal";
    case replay:
      return "runs with an expected force";
    case measured_surface:
      return "runs with a measured surface beside the true one";
    case slave:
      return "runs with a slave";
    default:
      return "all runs";
  }
}

bool applies(const Measure& measure, const Trace& trace) {
  switch (measure.runs) {
    case proxy:
      return !trace.has_tool();
    case contact:
      return !trace.has_tool() && trace.has_contact();
    case tool:
      return trace.has_tool();
    case guidance:
      return trace.has_guidance();
    case true_normal:
      return std::ranges::any_of(trace.true_normal, [](const Vec3& normal) { return normal.allFinite(); });
    case replay:
      return trace.has_replay();
    case measured_surface:
      return !trace.has_tool() && trace.has_contact() && trace.has_measured_surface();
    case slave:
      return trace.has_slave();
    default:
      return true;
  }
}

bool needs_true_contact(const Measure& measure) {
  return measure.runs == contact || measure.runs == true_normal || measure.runs == measured_surface;
}

double value_of(const Measure& measure, const Trace& trace) {
  return applies(measure, trace) ? measure.compute(trace) : kNoValue;
}

double popped_through(const Trace& trace) {
  return side_of_run(trace, judged_distance_m(trace)).popped_through;
}

double max_penetration_m(const Trace& trace) {
  return max_where(
      trace.length(), [&](std::size_t i) { return is_judged(trace, i); },
      [&](std::size_t i) { return std::max(0.0, -trace.signed_distance_m[i]); });  // no NaN
}

double min_slave_distance_m(const Trace& trace) {
  double min = std::numeric_limits<double>::infinity();
  for (const double distance : trace.slave_distance_m) min = std::min(min, distance);  // ignores NaN
  return std::isinf(min) ? kNoValue : min;
}

double wrong_side_fraction(const Trace& trace) {
  return mean_where(
      trace.length(), [&](std::size_t i) { return is_judged(trace, i); },
      [&](std::size_t i) { return trace.signed_distance_m[i] < -trace.held_depth_m; });
}

double no_force_fraction(const Trace& trace, double contact_radius_m) {
  return mean_where(
      trace.length(), [&](std::size_t i) { return pressing(trace, i, contact_radius_m); },
      [&](std::size_t i) { return !is_force(trace.force_N[i]); });
}

double mean_steps(const Trace& trace) {
  double sum = 0;
  for (const int steps : trace.proxy_steps) sum += steps;
  return trace.length() == 0 ? 0 : sum / static_cast<double>(trace.length());
}

double max_steps(const Trace& trace) {
  return trace.length() == 0 ? 0 : *std::ranges::max_element(trace.proxy_steps);  // no NaN: integers
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
  for (std::size_t i = 0; i < trace.length(); ++i) max = max_or_nan(max, trace.force_N[i].norm());
  return max;
}

}  // namespace remote_touch
