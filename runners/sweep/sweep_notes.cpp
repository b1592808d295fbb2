#include "runners/sweep/sweep_notes.h"

#include <algorithm>
#include <cmath>

#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/simulation/note_kinds.h"
#include "runners/sweep/cell_text.h"

namespace remote_touch {

std::string option_of_run(const SweepResult& result, std::size_t run) {
  std::string option = "--cell " + cell_text(result, result.cell_of(run));
  if (result.replicates > 1) option += " --replicate " + std::to_string(result.replicate_of(run));
  return option;
}

std::vector<std::string> note_lines(const SweepResult& result) {
  const std::string done = std::to_string(result.runs_in(RunState::done).size());
  std::vector<std::string> lines;
  for (const NoteCount& count : note_counts(result))
    lines.push_back(std::to_string(count.runs) + " of " + done + " runs: " + text_of_kind(count.kind) +
                    " (the first: " + option_of_run(result, count.first) + ")");
  return lines;
}

void refuse_notes(const SweepResult& result) {
  std::string all;
  for (const std::string& line : note_lines(result)) all += (all.empty() ? "" : "; ") + line;
  if (!all.empty()) throw InputError("--strict", all);
}

void add_unknown_outcome(const std::vector<Measure>& measures, const Trace& trace, std::vector<Note>& notes) {
  const auto is_known = [](double distance_m) { return !std::isnan(distance_m); };
  const auto is_unknown = [&](const Measure& measure) {
    return is_outcome(measure.name) && applies(measure, trace) && std::isnan(measure.compute(trace));
  };
  if (std::any_of(trace.signed_distance_m.begin(), trace.signed_distance_m.end(), is_known) &&
      std::any_of(measures.begin(), measures.end(), is_unknown))
    notes.push_back({"outcome unknown", "it is not known whether the proxy or tool popped through"});
}

void NoteCounts::add_run(std::int32_t bits) {
  const std::lock_guard lock(mutex_);
  ++runs_;
  for (std::size_t kind = 0; bits >> kind != 0; ++kind)
    if ((bits >> kind & 1) != 0) ++of_kind_[kind];
}

void NoteCounts::add(const std::vector<Note>& notes) {
  add_run(note_bits(notes));
}

void NoteCounts::add(const SweepResult& result) {
  for (const std::size_t run : result.runs_in(RunState::done)) add_run(result.notes[run]);
}

std::vector<std::string> NoteCounts::lines() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines;
  for (const auto& [kind, runs] : of_kind_)
    lines.push_back(std::to_string(runs) + " of " + std::to_string(runs_) +
                    " runs: " + text_of_kind(note_kinds()[kind].name));
  return lines;
}

}  // namespace remote_touch
