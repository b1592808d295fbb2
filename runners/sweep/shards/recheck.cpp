#include "runners/sweep/shards/recheck.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <new>

#include "runners/sweep/sweep_run.h"

namespace remote_touch {

namespace {

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// Makes the runs, some at a time, and calls compare(part, place) for each, in their order.
void make_again(const Sweep& sweep, const std::vector<std::uint64_t>& runs, const RecheckOptions& options,
                const std::function<void(const SweepResult& part, std::size_t place)>& compare) {
  constexpr std::size_t kTogether = 64;
  for (std::size_t first = 0; first < runs.size(); first += kTogether) {
    const std::size_t end = std::min(first + kTogether, runs.size());
    const auto begin = runs.begin();
    SweepResult part =
        sweep.part({begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end)});
    if (do_pending_runs(sweep, part, {options.kernels, options.stop}) > 0) throw std::bad_alloc();
    for (std::size_t place = 0; place < part.held_count(); ++place) compare(part, place);
    if (options.progress) options.progress(end, runs.size());
  }
}

// Returns what differs between a stored run and the same run now; empty if nothing does.
std::string difference(const SweepResult& stored, std::size_t at, const SweepResult& now, std::size_t place) {
  if (stored.state[at] != now.state[place])
    return now.state[place] == RunState::failed ? "was done, now fails: " + now.error[place]
                                                : "failed, now is done";
  for (std::size_t m = 0; m < stored.measures.size(); ++m) {
    const double then = std::get<std::vector<double>>(stored.measures[m].values)[at],
                 again = std::get<std::vector<double>>(now.measures[m].values)[place];
    if (bits(then) != bits(again))
      return stored.measures[m].name + " = " + digits(then) + ", now " + digits(again);
  }
  if (!stored.notes.empty() && stored.notes[at] != now.notes[place]) return "has other notes now";
  return "";
}

std::vector<std::uint64_t> chosen_runs(const SweepResult& part) {
  std::vector<std::uint64_t> chosen, all;
  for (std::size_t place = 0; place < part.held_count(); ++place)
    if (part.state[place] == RunState::done || part.state[place] == RunState::failed)
      (is_rechecked(part.run_at(place)) ? chosen : all).push_back(part.run_at(place));
  if (chosen.empty() && !all.empty()) chosen.push_back(all.front());
  return chosen;
}

// Returns the indices of the chosen cells of the tally.
std::vector<std::size_t> chosen_cells(const SweepTally& tally) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < tally.cells.size(); ++i)
    if (is_rechecked(tally.cells[i])) chosen.push_back(i);
  if (chosen.empty() && !tally.cells.empty()) chosen.push_back(tally.cells.size() / 2);
  return chosen;
}

// Returns what differs between two tallies that are not equal. name: that of the measure.
std::string difference(const std::string& name, const MeasureTally& then, const MeasureTally& now) {
  const auto part = [&](const char* what, double before, double after) {
    return std::string(what) + " of " + name + " = " + digits(before) + ", now " + digits(after);
  };
  if (bits(then.mean()) != bits(now.mean())) return part("mean", then.mean(), now.mean());
  if (bits(then.least) != bits(now.least)) return part("least value", then.least, now.least);
  if (bits(then.greatest) != bits(now.greatest)) return part("greatest value", then.greatest, now.greatest);
  return "other values of " + name + " now, with the same mean";
}

// Returns what differs between the tallies of one cell; empty if nothing does.
std::string difference(const std::vector<Column>& measures, const CellTally& then, const CellTally& now) {
  if (then == now) return "";
  for (std::size_t m = 0; m < measures.size(); ++m)
    if (!(then.measures[m] == now.measures[m]))
      return difference(measures[m].name, then.measures[m], now.measures[m]);
  return "other failed runs, notes or events now";
}

// Returns the runs of a cell that the tally has.
std::vector<std::uint64_t> held_runs(const SweepTally& tally, std::uint64_t cell) {
  const auto replicates = static_cast<std::uint64_t>(tally.replicates);
  std::vector<std::uint64_t> runs;
  for (std::uint64_t run = cell * replicates; run < (cell + 1) * replicates; ++run)
    if (tally.held.count_in({run, run + 1}) > 0) runs.push_back(run);
  return runs;
}

}  // namespace

Recheck recheck(const SweepResult& part, const Sweep& sweep, const RecheckOptions& options) {
  const std::vector<std::uint64_t> runs = chosen_runs(part);
  Recheck check{runs.size()};
  make_again(sweep, runs, options, [&](const SweepResult& now, std::size_t place) {
    const std::string how = difference(part, part.place_of(now.run_at(place)).value(), now, place);
    if (!how.empty()) check.different.push_back("run " + std::to_string(now.run_at(place)) + ": " + how);
  });
  return check;
}

Recheck recheck(const SweepTally& tally, const Sweep& sweep, const RecheckOptions& options) {
  const std::vector<std::size_t> chosen = chosen_cells(tally);
  Recheck check{0, chosen.size(), tally.cells.size()};
  const TallyLayout layout = tally.layout();
  for (const std::size_t i : chosen) {
    const std::vector<std::uint64_t> runs = held_runs(tally, tally.cells[i]);
    CellTally now(layout);
    make_again(sweep, runs, options, [&](const SweepResult& made, std::size_t place) {
      std::vector<double> values;
      for (const Column& measure : made.measures)
        values.push_back(std::get<std::vector<double>>(measure.values)[place]);
      const std::uint64_t run = made.run_at(place);
      if (made.state[place] == RunState::done)
        now.add_done(layout, run, values, made.notes[place]);
      else
        now.add_failed(run, made.error[place]);
    });
    check.made += runs.size();
    const std::string how = difference(tally.measures, tally.tallies[i], now);
    if (!how.empty()) check.different.push_back("cell " + std::to_string(tally.cells[i]) + ": " + how);
  }
  return check;
}

}  // namespace remote_touch
