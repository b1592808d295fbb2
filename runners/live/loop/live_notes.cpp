#include "runners/live/loop/live_notes.h"

#include <cstdio>
#include <utility>

namespace remote_touch {

namespace {

// A live session loses single frames without harm: the next one comes a thirtieth of a second later.
constexpr double kUnusedShare = 0.1;

std::string frames_line(const LiveFacts& facts) {
  char rate[32];
  std::snprintf(rate, sizeof rate, "%.4g Hz", facts.view.frame_rate_hz);
  return std::to_string(facts.camera.received) + " frame(s) from " + facts.depth + ", " +
         layout_text(facts.view) + " at " + rate + "; " + std::to_string(facts.sensed.frames()) +
         " processed: " + facts.sensed.text();
}

void add_unused_frames(const CameraCounts& camera, std::vector<Note>& notes) {
  const std::pair<int, const char*> parts[] = {
      {camera.skipped, "not sent, or replaced before they were processed"},
      {camera.reversed, "reversed or repeated"},
      {camera.incomplete, "without all pixels or colours"},
      {camera.unrecorded, "dropped for the recorder"},
      {camera.overtaken, "replaced before the haptic loop used them"}};
  const int all = camera.received + camera.skipped;
  int unused = 0;
  std::string reasons;
  for (const auto& [count, reason] : parts) {
    unused += count;
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  }
  if (unused > kUnusedShare * all)
    notes.push_back({"frames unused", std::to_string(unused) + " of " + std::to_string(all) +
                                          " frames were not used: " + reasons});
}

}  // namespace

std::vector<Phase> simulated_phases(const Experiment& experiment, const std::string& device,
                                    const std::string& depth, const Kernels& kernels) {
  const auto is_simulated = [](const std::string& address) { return address.starts_with("sim:"); };
  std::vector<Phase> phases = experiment.phases();
  const auto add = [&](std::vector<Phase> more) {
    for (Phase& phase : more) phases.push_back(std::move(phase));
  };
  if (!is_simulated(device) && !is_simulated(depth)) return phases;
  const auto scenario = experiment.build_scenario(kernels);
  if (is_simulated(depth)) add(scenario->phases());
  if (is_simulated(device)) {
    add(experiment.build_trajectory(*scenario)->phases());
    add(experiment.operator_phases());
  }
  return phases;
}

RunReport report_of(const LiveFacts& facts) {
  RunReport report;
  report.inputs.push_back(frames_line(facts));
  if (facts.log.latency_s.size() == 0)
    report.notes.push_back({"no frame", "no frame arrived before the session ended"});
  else if (facts.log.contact_ticks == 0)
    report.notes.push_back(no_contact_note());
  add_unused_frames(facts.camera, report.notes);
  add_missed_phases(facts.phases, static_cast<double>(facts.log.end_tick()) / facts.haptic_rate_hz,
                    report.notes);
  return report;
}

}  // namespace remote_touch
