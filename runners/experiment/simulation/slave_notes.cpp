#include "runners/experiment/simulation/slave_notes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/measures/passivity_measures.h"
#include "analysis/measures/slave_measures.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// A hand of 0.5 kg has this energy at 4.5 m/s. Rendered surfaces give a hand at most 1.6 J in the scenes of
// the scorecard.
constexpr double kMuchEnergy_J = 5;

// Returns true if every command that the slave had is the first one that it was meant to have, and later ones
// were meant for it. Ticks before the first command have NaN.
bool kept_first_command(const Trace& trace) {
  const auto first = std::find_if(trace.received_command_m.begin(), trace.received_command_m.end(),
                                  [](const Vec3& command) { return command.allFinite(); });
  if (first == trace.received_command_m.end()) return false;
  const auto is_first = [&](const Vec3& command) { return command == *first; };
  const auto is_other = [&](const Vec3& command) { return command.allFinite() && command != *first; };
  return std::all_of(first, trace.received_command_m.end(), is_first) &&
         std::any_of(trace.slave_command_m.begin(), trace.slave_command_m.end(), is_other);
}

}  // namespace

std::vector<Note> slave_notes(const Trace& trace) {
  std::vector<Note> notes;
  if (!trace.has_slave()) return notes;
  const auto is_unknown = [](double clearance) { return std::isnan(clearance); };
  if (std::all_of(trace.slave_clearance_m.begin(), trace.slave_clearance_m.end(), is_unknown))
    notes.push_back({"slave without surface",
                     "the true surface is not known where the slave was, so it could not touch anything"});
  if (kept_first_command(trace))
    notes.push_back(
        {"slave without command",
         "the slave received no command after its first: all were lost, late or in the dead-band"});
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

}  // namespace remote_touch
