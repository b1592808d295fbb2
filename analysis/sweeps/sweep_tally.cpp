#include "analysis/sweeps/sweep_tally.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "analysis/storage/digest.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// Returns an iterator to the first range that ends after the run.
auto first_after(const std::vector<RunRange>& ranges, std::uint64_t run) {
  return std::upper_bound(ranges.begin(), ranges.end(), run,
                          [](std::uint64_t number, const RunRange& range) { return number < range.end; });
}

}  // namespace

void RunRanges::add(RunRange range) {
  if (range.first == range.end) return;
  auto next = ranges_.begin() + (first_after(ranges_, range.first) - ranges_.cbegin());
  const bool joins_next = next != ranges_.end() && next->first == range.end;
  const bool joins_last = next != ranges_.begin() && std::prev(next)->end == range.first;
  if (joins_next && joins_last) {
    std::prev(next)->end = next->end;
    ranges_.erase(next);
  } else if (joins_next) {
    next->first = range.first;
  } else if (joins_last) {
    std::prev(next)->end = range.end;
  } else {
    ranges_.insert(next, range);
  }
}

void RunRanges::add(const RunRanges& other) {
  std::vector<RunRange> all;
  std::merge(ranges_.begin(), ranges_.end(), other.ranges_.begin(), other.ranges_.end(),
             std::back_inserter(all), [](const RunRange& a, const RunRange& b) { return a.first < b.first; });
  ranges_.clear();
  for (const RunRange& range : all)
    if (!ranges_.empty() && ranges_.back().end == range.first)
      ranges_.back().end = range.end;
    else
      ranges_.push_back(range);
}

std::uint64_t RunRanges::count() const {
  std::uint64_t count = 0;
  for (const RunRange& range : ranges_) count += range.end - range.first;
  return count;
}

std::uint64_t RunRanges::count_in(RunRange range) const {
  std::uint64_t count = 0;
  for (auto at = first_after(ranges_, range.first); at != ranges_.end() && at->first < range.end; ++at)
    count += std::min(at->end, range.end) - std::max(at->first, range.first);
  return count;
}

RunRange RunRanges::first_common(const RunRanges& other) const {
  for (auto a = ranges_.begin(), b = other.ranges_.begin(); a != ranges_.end() && b != other.ranges_.end();) {
    const RunRange common{std::max(a->first, b->first), std::min(a->end, b->end)};
    if (common.first < common.end) return common;
    ++(a->end <= b->end ? a : b);
  }
  return {};
}

RunRanges RunRanges::missing_in(RunRange range) const {
  RunRanges missing;
  std::uint64_t next = range.first;
  for (auto at = first_after(ranges_, range.first); at != ranges_.end() && at->first < range.end; ++at) {
    if (at->first > next) missing.ranges_.push_back({next, at->first});
    next = at->end;
  }
  if (next < range.end) missing.ranges_.push_back({next, range.end});
  return missing;
}

namespace {

// "run 12 is", "runs 12 to 15 are".
std::string named(RunRange range) {
  const std::string first = std::to_string(range.first);
  if (range.end - range.first == 1) return "run " + first + " is";
  return "runs " + first + " to " + std::to_string(range.end - 1) + " are";
}

// Compares values by their bits.
bool is_same_column(const Column& a, const Column& b) {
  return a.units == b.units && a.long_name == b.long_name && a.value_names == b.value_names &&
         a.values.index() == b.values.index() && digest({a}) == digest({b});
}

std::string difference(const char* what, const std::vector<Column>& a, const std::vector<Column>& b) {
  const std::string whose = std::string("their ") + what;
  if (names_of(a) != names_of(b))
    return whose + " are " + joined(names_of(a), ", ") + " and " + joined(names_of(b), ", ");
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!is_same_column(a[i], b[i])) return whose + " " + a[i].name + " differ";
  return "";
}

bool has_layout(const CellTally& tally, const TallyLayout& layout) {
  return tally.measures.size() == layout.measures && tally.notes.size() == layout.note_kinds &&
         tally.events.size() == layout.events.size();
}

// True if every number of a run that the tally names is in the range.
bool names_runs_in(const CellTally& tally, RunRange range) {
  const auto is_in = [&](std::uint64_t run) { return run >= range.first && run < range.end; };
  return (tally.failed == 0 || is_in(tally.first_failed)) &&
         std::all_of(tally.notes.begin(), tally.notes.end(),
                     [&](const NoteTally& note) { return note.runs == 0 || is_in(note.first); }) &&
         std::all_of(tally.events.begin(), tally.events.end(), [&](const std::vector<std::uint64_t>& runs) {
           return runs.empty() || (is_in(runs.front()) && is_in(runs.back()));
         });
}

}  // namespace

CellTally SweepTally::over_all_cells() const {
  CellTally all(layout());
  for (const CellTally& cell : tallies) all.add(cell);
  return all;
}

const CellTally* SweepTally::tally_of(std::uint64_t cell) const {
  const auto found = std::lower_bound(cells.begin(), cells.end(), cell);
  if (found == cells.end() || *found != cell) return nullptr;
  return &tallies[static_cast<std::size_t>(found - cells.begin())];
}

TallyLayout SweepTally::layout() const {
  TallyLayout layout{measures.size(), note_kinds.size(), {}};
  for (std::size_t i = 0; keeps_events && i < measures.size(); ++i)
    if (is_event(measures[i])) layout.events.push_back(i);
  return layout;
}

CellTally& SweepTally::tally_for(const TallyLayout& layout, std::uint64_t run) {
  if (run >= run_count() || held.count_in({run, run + 1}) > 0)
    throw std::invalid_argument("run " + std::to_string(run) +
                                " is in the tally already, or not in the sweep");
  held.add({run, run + 1});
  const std::uint64_t cell = run / static_cast<std::uint64_t>(replicates);
  const auto at = std::lower_bound(cells.begin(), cells.end(), cell);
  const auto tally = tallies.begin() + (at - cells.begin());
  if (at != cells.end() && *at == cell) return *tally;
  cells.insert(at, cell);
  return *tallies.emplace(tally, layout);
}

void SweepTally::add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                          std::uint64_t note_bits) {
  tally_for(layout, run).add_done(layout, run, values, note_bits);
}

void SweepTally::add_failed(const TallyLayout& layout, std::uint64_t run, const std::string& error) {
  tally_for(layout, run).add_failed(run, error);
}

std::string SweepTally::obstacle(const SweepTally& other) const {
  if (std::string axis = difference("axes", axes, other.axes); !axis.empty()) return axis;
  if (std::string measure = difference("measures", measures, other.measures); !measure.empty())
    return measure;
  if (replicates != other.replicates)
    return "they have " + std::to_string(replicates) + " and " + std::to_string(other.replicates) +
           " replicates";
  if (note_kinds != other.note_kinds) return "their kinds of notes differ";
  if (keeps_events != other.keeps_events) return "only one of them keeps the runs of events";
  const RunRange common = held.first_common(other.held);
  return common == RunRange{} ? "" : named(common) + " in both";
}

void SweepTally::add(SweepTally other) {
  const std::string reason = obstacle(other);
  if (!reason.empty()) throw InputError("tallies", reason + ": expected different runs of one sweep");
  std::vector<std::uint64_t> all_cells;
  std::vector<CellTally> all;
  std::set_union(cells.begin(), cells.end(), other.cells.begin(), other.cells.end(),
                 std::back_inserter(all_cells));
  all.reserve(all_cells.size());
  for (std::size_t i = 0, j = 0; all.size() < all_cells.size();) {
    const std::uint64_t cell = all_cells[all.size()];
    const bool here = i < cells.size() && cells[i] == cell;
    const bool there = j < other.cells.size() && other.cells[j] == cell;
    all.push_back(std::move(here ? tallies[i] : other.tallies[j]));
    if (here && there) all.back().add(other.tallies[j]);
    i += here ? 1 : 0, j += there ? 1 : 0;
  }
  cells = std::move(all_cells), tallies = std::move(all);
  held.add(other.held);
}

std::string SweepTally::contradiction() const {
  if (cells.size() != tallies.size()) return "there are cells without a tally";
  std::uint64_t runs = 0;
  const TallyLayout expected = layout();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i] >= cell_count() || (i > 0 && cells[i] <= cells[i - 1]))
      return "the cells are not increasing";
    const std::string cell = "cell " + std::to_string(cells[i]);
    if (!has_layout(tallies[i], expected)) return cell + " has other measures or kinds of notes";
    if (const std::string wrong = tallies[i].contradiction(); !wrong.empty()) return cell + ": " + wrong;
    const std::uint64_t first = cells[i] * static_cast<std::uint64_t>(replicates);
    const RunRange range{first, first + static_cast<std::uint64_t>(replicates)};
    const std::uint64_t of_cell = held.count_in(range);
    if (of_cell == 0 || of_cell != static_cast<std::uint64_t>(tallies[i].runs()))
      return cell + " has another number of runs";
    if (!names_runs_in(tallies[i], range)) return cell + " names a run of another cell";
    runs += of_cell;
  }
  return runs == held.count() ? "" : "there are runs of cells without a tally";
}

EventCounts event_counts(const SweepTally& tally, std::size_t measure, std::uint64_t cell) {
  const CellTally* const own = tally.tally_of(cell);
  if (!own) return {};
  const MeasureTally& m = own->measures[measure];
  const auto events = static_cast<std::int64_t>(m.sum.value());
  return {events, m.values - events, m.unknown};
}

std::int64_t noted_runs(const SweepTally& tally, std::uint64_t cell) {
  std::int64_t most = 0;
  if (const CellTally* const own = tally.tally_of(cell))
    for (const NoteTally& note : own->notes) most = std::max(most, note.runs);
  return most;
}

}  // namespace remote_touch
