#include "runners/experiment/simulation/slave_notes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/measures/force_fidelity.h"
#include "analysis/measures/tool_and_slave_measures.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// A hand of 0.5 kg has this energy at 4.5 m/s. Rendered surfaces give a hand at most 1.6 J in the scenes of
// the scorecard.
constexpr double kMuchEnergy_J = 5;

bool is_started(const Trace& trace) {
  return std::any_of(trace.received_command_m.begin(), trace.received_command_m.end(),
                     [](const Vec3& command) { return command.allFinite(); });
}

// Returns true if every command that the slave had is the first one that it was meant to have, and later ones
// were meant for it. Ticks before the first command have NaN. A command that is sent in the last tick cannot
// move the slave any more.
bool kept_first_command(const Trace& trace) {
  const auto first = std::find_if(trace.received_command_m.begin(), trace.received_command_m.end(),
                                  [](const Vec3& command) { return command.allFinite(); });
  const auto is_first = [&](const Vec3& command) { return command == *first; };
  const auto is_other = [&](const Vec3& command) { return command.allFinite() && command != *first; };
  return std::all_of(first, trace.received_command_m.end(), is_first) &&
         std::any_of(trace.slave_command_m.begin(), trace.slave_command_m.end() - 1, is_other);
}

// Only a slave that the hand is to feel sends forces.
bool sends_forces(const Trace& trace) {
  return trace.force_packets.back() > 0;
}

bool feels_nothing(const Trace& trace) {
  const auto is_zero = [](const Vec3& force) { return force.isZero(0); };
  return !std::isnan(first_slave_contact_time_s(trace)) &&
         std::all_of(trace.device_force_N.begin(), trace.device_force_N.end(), is_zero);
}

// The slave is put at its first command in one tick, and pushed out from the next one on.
void add_start(const Trace& trace, std::vector<Note>& notes) {
  constexpr double kRounding_m = 1e-9;
  const auto is_known = [](const Vec3& position) { return position.allFinite(); };
  const auto first = std::ranges::find_if(trace.slave_position_m, is_known);
  const auto tick = static_cast<std::size_t>(first - trace.slave_position_m.begin());
  const double depth_m = -trace.slave_clearance_m[tick];
  if (!(depth_m > kRounding_m)) return;
  const double force_N = tick + 1 < trace.length() ? trace.slave_peak_force_N[tick + 1] : 0;
  char text[160];
  std::snprintf(text, sizeof text,
                "the slave starts %.3g mm behind the true surface, with a force of %.3g N on it: largest "
                "forces of the run may be those of its start",
                1e3 * depth_m, force_N);
  notes.push_back({"slave starts in contact", text});
}

}  // namespace

std::vector<Note> slave_notes(const Trace& trace) {
  std::vector<Note> notes;
  if (!trace.has_slave() || trace.length() == 0) return notes;
  if (!is_started(trace))
    return {{"slave without command", "the slave never started: no command was finite"}};
  const auto is_unknown = [](double clearance) { return std::isnan(clearance); };
  if (std::all_of(trace.slave_clearance_m.begin(), trace.slave_clearance_m.end(), is_unknown))
    notes.push_back({"slave without surface",
                     "the true surface is not known where the slave was, so it could not touch anything"});
  else if (std::isnan(max_slave_force_N(trace)))
    notes.push_back(
        {"slave without surface",
         "the normal of the true surface is not known where the slave was behind it, so there was "
         "no force on it, and measures of its force have no value"});
  add_start(trace, notes);
  if (kept_first_command(trace))
    notes.push_back(
        {"slave without command",
         "the slave received no command after its first: all were lost, late or in the dead-band"});
  if (!sends_forces(trace)) return notes;
  if (feels_nothing(trace))
    notes.push_back(
        {"slave without command",
         "the hand felt no force of the slave: all were lost, late, in the dead-band, or stopped by "
         "gain or device"});
  if (const double given_J = max_energy_injected_J(trace); given_J > kMuchEnergy_J) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the device gave the hand up to %.3g J, with a force of up to %.3g N: hand, links and slave "
        "may oscillate",
        given_J, max_device_force_N(trace));
    notes.push_back({"slave loop gains energy", text});
  }
  return notes;
}

std::vector<Note> slave_setting_notes(const Experiment& experiment, Experiment::Hand hand) {
  constexpr const char* kKind = "setting without effect";
  const auto setting = [&](const char* path) { return experiment.value_at_start(path); };
  std::vector<Note> notes;
  if (!setting("slave").is_object()) return notes;
  const std::string force = setting("feedback.force").get<std::string>();
  if (force != "rendered" && !setting("fixtures").empty())
    notes.push_back({kKind, "fixtures hold nothing back with feedback.force = " + force +
                                ": the HIP is sent to the slave, and the hand does not feel the renderer"});
  const bool is_scripted = hand == Experiment::Hand::simulated && !setting("operator").is_object() &&
                           setting("trajectory.name") != "live-session";
  if (is_scripted && force != "rendered" && force != "none")
    notes.push_back({kKind, "feedback.force = " + force +
                                " moves nothing: without the section operator the hand follows its path, "
                                "whatever the device exerts"});
  return notes;
}

std::string slave_summary(const Trace& trace) {
  const double clearance_m = min_slave_clearance_m(trace);
  if (std::isnan(clearance_m)) return {};
  char text[120];
  const double touched = slave_touched(trace);
  if (std::isnan(touched))
    std::snprintf(text, sizeof text, "it is not known whether the slave touched: its force is unknown");
  else if (touched > 0)
    std::snprintf(text, sizeof text,
                  "the slave touched first at %.3f s; largest force of the scene on it: %.3g N",
                  first_slave_contact_time_s(trace), max_slave_force_N(trace));
  else
    std::snprintf(text, sizeof text, "the slave did not touch; it came within %.3g mm of the surface",
                  1e3 * clearance_m);
  return text;
}

}  // namespace remote_touch
