#include "analysis/sweeps/sweep_result.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace remote_touch {

void SweepResult::start(bool refined) {
  const std::size_t runs = run_count();
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

std::vector<std::size_t> SweepResult::runs_in(RunState requested) const {
  std::vector<std::size_t> runs;
  for (std::size_t run = 0; run < state.size(); ++run)
    if (state[run] == requested) runs.push_back(run);
  return runs;
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
    for (std::size_t run = result.notes.size(); run-- > 0;)
      if (result.state[run] == RunState::done && (result.notes[run] >> kind & 1) != 0)
        ++count.runs, count.first = run;
    if (count.runs > 0) counts.push_back(std::move(count));
  }
  return counts;
}

Tally tally(const SweepResult& result, const std::vector<double>& measure, std::size_t cell, double above) {
  Tally tally;
  for (int replicate = 0; replicate < result.replicates; ++replicate) {
    const std::size_t run = result.run(cell, replicate);
    if (result.state[run] != RunState::done) continue;
    ++tally.runs;
    tally.events += measure[run] > above ? 1 : 0;
  }
  return tally;
}

}  // namespace remote_touch
