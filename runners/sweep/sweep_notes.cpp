#include "runners/sweep/sweep_notes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/measures/run_events.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/sweep/cell_text.h"
#include "runners/sweep/tally_outline.h"

namespace remote_touch {

namespace {

// pre: the distance that judges the run is unknown in some tick, as in every run with a frame whose outcome
// is unknown.
std::string text_of_unknown_outcome(const Trace& trace) {
  const std::vector<double>& distance_m = judged_distance_m(trace);
  std::size_t unknown = 0, last = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (std::isnan(distance_m[i])) last = i, ++unknown;
  char text[320];
  std::snprintf(
      text, sizeof text,
      "it is not known whether the %s popped through: its distance to the %s surface is unknown in "
      "%.3g %% of the ticks, last at %.6g s, beside an object or at a depth edge for example; choose a "
      "larger scene, or a hand that stays over it",
      trace.has_tool() ? "tool" : "proxy", trace.has_measured_surface() ? "measured" : "true",
      100 * static_cast<double>(unknown) / static_cast<double>(trace.length()), trace.time_s[last]);
  return text;
}

}  // namespace

std::string option_of_run(const SweepResult& result, std::size_t run) {
  std::string option = "--cell " + cell_text(result, result.cell_of(run));
  if (result.replicates > 1) option += " --replicate " + std::to_string(result.replicate_of(run));
  return option;
}

std::vector<std::string> note_lines(const SweepResult& result) {
  return note_lines(result, note_counts(result), result.runs_in(RunState::done).size());
}

std::vector<std::string> note_lines(const SweepResult& sweep, const std::vector<NoteCount>& counts,
                                    std::size_t done) {
  std::vector<std::string> lines;
  for (const NoteCount& count : counts)
    lines.push_back(std::to_string(count.runs) + " of " + std::to_string(done) + " runs: " +
                    text_of_kind(count.kind) + " (the first: " + option_of_run(sweep, count.first) + ")");
  return lines;
}

std::vector<std::string> note_lines(const SweepTally& tally) {
  CellTally all(tally.layout());
  for (const CellTally& cell : tally.tallies) all.add(cell);
  std::vector<NoteCount> counts;
  for (std::size_t i = 0; i < all.notes.size(); ++i)
    if (all.notes[i].runs > 0)
      counts.push_back({tally.note_kinds[i], static_cast<std::size_t>(all.notes[i].runs),
                        static_cast<std::size_t>(all.notes[i].first)});
  return note_lines(outline_of(tally), counts, static_cast<std::size_t>(all.done));
}

namespace {

void refuse(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += (all.empty() ? "" : "; ") + line;
  if (!all.empty()) throw InputError("--strict", all);
}

}  // namespace

void refuse_notes(const SweepResult& result) {
  refuse(note_lines(result));
}

void refuse_notes(const SweepTally& tally) {
  refuse(note_lines(tally));
}

void add_unknown_outcome(std::span<const Measure> measures, const Trace& trace, std::vector<Note>& notes) {
  const auto is_known = [&](std::size_t i) {
    return trace.frame_index[i] >= 0 && !std::isnan(trace.signed_distance_m[i]);
  };
  const auto is_unknown = [&](const Measure& measure) {
    return is_outcome(measure.name) && applies(measure, trace) && std::isnan(measure.compute(trace));
  };
  if (first_tick(trace, is_known) >= 0 && std::any_of(measures.begin(), measures.end(), is_unknown))
    notes.push_back({"outcome unknown", text_of_unknown_outcome(trace)});
}

void NoteCounts::add_run(std::uint64_t bits) {
  const std::lock_guard lock(mutex_);
  ++runs_;
  for (std::size_t kind = 0; kind < note_kinds().size(); ++kind)
    if ((bits >> kind & 1) != 0) ++of_kind_[kind];
}

void NoteCounts::add(const std::vector<Note>& notes) {
  add_run(note_bits(notes));
}

void NoteCounts::add(const SweepResult& result) {
  for (const std::size_t place : result.runs_in(RunState::done)) add_run(result.notes[place]);
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
