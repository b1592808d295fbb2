#include "analysis/sweeps/sweep_result.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace remote_touch {

void SweepResult::start(bool refined) {
  const std::size_t runs = held_count();
  for (Column& measure : measures)
    measure.values = std::vector<double>(runs, std::numeric_limits<double>::quiet_NaN());
  state.assign(runs, RunState::not_sampled);
  round.assign(refined ? runs : 0, -1);
  error.assign(runs, {});
  notes.assign(note_kinds.empty() ? 0 : runs, 0);
}

std::size_t SweepResult::cell_count() const {
  std::size_t count = 1;
  for (const Column& axis : axes) count *= axis.length();
  return count;
}

std::vector<std::size_t> SweepResult::axis_indices(std::size_t cell) const {
  std::vector<std::size_t> indices(axes.size());
  for (std::size_t i = axes.size(); i-- > 0; cell /= axes[i].length()) indices[i] = cell % axes[i].length();
  return indices;
}

std::size_t SweepResult::cell_at(const std::vector<std::size_t>& indices) const {
  std::size_t cell = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) cell = cell * axes[i].length() + indices[i];
  return cell;
}

std::optional<std::size_t> SweepResult::place_of(std::size_t run) const {
  if (!part) return run;
  const auto found = std::lower_bound(part->begin(), part->end(), run);
  if (found == part->end() || *found != run) return std::nullopt;
  return static_cast<std::size_t>(found - part->begin());
}

std::vector<std::size_t> SweepResult::runs_in(RunState requested) const {
  std::vector<std::size_t> places;
  for (std::size_t place = 0; place < state.size(); ++place)
    if (state[place] == requested) places.push_back(place);
  return places;
}

const std::vector<double>& SweepResult::measure(const std::string& name) const {
  for (const Column& measure : measures)
    if (measure.name == name) return std::get<std::vector<double>>(measure.values);
  throw std::out_of_range("the sweep has no measure " + name);
}

bool is_event(const Column& measure) {
  return measure.units == "1" && measure.long_name.starts_with("1 when ");
}

std::vector<NoteCount> note_counts(const SweepResult& result) {
  std::vector<NoteCount> counts;
  for (std::size_t kind = 0; kind < result.note_kinds.size(); ++kind) {
    NoteCount count{result.note_kinds[kind]};
    for (std::size_t place = result.notes.size(); place-- > 0;)
      if (result.state[place] == RunState::done && (result.notes[place] >> kind & 1) != 0)
        ++count.runs, count.first = result.run_at(place);
    if (count.runs > 0) counts.push_back(std::move(count));
  }
  return counts;
}

namespace {

// Copies the elements of one run.
void copy_run(const SweepResult& from, std::size_t place, SweepResult& to, std::size_t to_place) {
  for (std::size_t i = 0; i < to.measures.size(); ++i)
    std::get<std::vector<double>>(to.measures[i].values)[to_place] =
        std::get<std::vector<double>>(from.measures[i].values)[place];
  to.state[to_place] = from.state[place];
  to.error[to_place] = from.error[place];
  if (!to.round.empty()) to.round[to_place] = from.round[place];
  if (!to.notes.empty()) to.notes[to_place] = from.notes[place];
}

// Returns a result of the same sweep that holds other runs, which are not sampled.
SweepResult emptied(const SweepResult& result, std::optional<std::vector<std::uint64_t>> part) {
  SweepResult other;
  other.axes = result.axes, other.replicates = result.replicates, other.part = std::move(part);
  for (const Column& measure : result.measures)
    other.measures.push_back({measure.name, measure.units, measure.long_name, {}, measure.width, {}});
  other.note_kinds = result.note_kinds;
  other.start(!result.round.empty());
  return other;
}

}  // namespace

SweepResult whole_of(SweepResult result) {
  if (!result.part) return result;
  SweepResult whole = emptied(result, std::nullopt);
  if (result.round.empty()) whole.state.assign(whole.run_count(), RunState::elsewhere);
  for (std::size_t place = 0; place < result.held_count(); ++place)
    copy_run(result, place, whole, result.run_at(place));
  return whole;
}

SweepResult without_others(SweepResult result) {
  if (result.part || result.runs_in(RunState::elsewhere).empty()) return result;
  std::vector<std::uint64_t> held;
  for (std::size_t run = 0; run < result.run_count(); ++run)
    if (result.state[run] != RunState::elsewhere && result.state[run] != RunState::not_sampled)
      held.push_back(run);
  SweepResult part = emptied(result, held);
  for (std::size_t place = 0; place < held.size(); ++place) copy_run(result, held[place], part, place);
  return part;
}

EventCounts event_counts(const SweepResult& result, const std::vector<double>& measure, std::size_t cell,
                         double above) {
  EventCounts counts;
  for (int replicate = 0; replicate < result.replicates; ++replicate) {
    const std::size_t run = result.run(cell, replicate);
    if (result.state[run] != RunState::done) continue;
    ++(std::isnan(measure[run]) ? counts.unknown : measure[run] > above ? counts.events : counts.without);
  }
  return counts;
}

}  // namespace remote_touch
