#include "analysis/sweeps/sweep_tally.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

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

namespace {

using Numbers = std::vector<std::int32_t>;

// Rounds to 16 significant bits, 1 in 130 000. The other bits would make the file larger, and nobody needs
// them: the sums have all of them.
double in_16_bits(double value) {
  constexpr std::uint64_t kDropped = std::uint64_t{1} << 37;
  if (!std::isfinite(value)) return value;
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(value) + kDropped / 2) & ~(kDropped - 1));
}

// Returns how far the stored rows reach from the bucket of the median: to the farthest bucket, but at most so
// far that the array has four values for each bucket in use.
std::int32_t reach_of(const SweepTally& tally, std::size_t measure) {
  std::size_t used = 0;
  std::int32_t farthest = 0;
  for (const CellTally& cell : tally.tallies) {
    const QuantileSketch& sketch = cell.measures[measure].sketch;
    const auto pairs = sketch.pairs();
    if (pairs.empty()) continue;
    const std::int32_t median = sketch.bucket_at(0.5);
    used += pairs.size();
    farthest = std::max({farthest, median - pairs.front().first, pairs.back().first - median});
  }
  const std::size_t rows = std::max<std::size_t>(1, 4 * used / std::max<std::size_t>(1, tally.cells.size()));
  return std::min(farthest, static_cast<std::int32_t>((rows - 1) / 2));
}

// Builds the arrays of a tally; `over_cells` are the axes of an array with one value for each cell.
class ArrayBuilder {
 public:
  explicit ArrayBuilder(const SweepTally& tally) : tally_(tally) {}

  TallyArrays built() {
    add_scales();
    add_counts();
    add_notes();
    for (std::size_t i = 0; i < tally_.measures.size(); ++i) add_measure(i);
    add_runs();
    return std::move(arrays_);
  }

 private:
  template <class Value, class Of>
  std::vector<Value> of_cells(Of&& of) const {
    std::vector<Value> values;
    values.reserve(tally_.tallies.size());
    for (const CellTally& cell : tally_.tallies) values.push_back(static_cast<Value>(of(cell)));
    return values;
  }
  template <class Values>
  void add_array(const std::string& name, const std::string& unit, const std::string& meaning, Values values,
                 const std::string& first_axis = "") {
    std::vector<std::string> axes;
    if (!first_axis.empty()) axes.push_back(first_axis);
    axes.insert(axes.end(), over_cells_.begin(), over_cells_.end());
    arrays_.arrays.push_back({{name, unit, meaning, std::move(values)}, std::move(axes)});
  }
  void add_scale(const std::string& name, const std::string& meaning, std::int32_t first, std::int32_t last,
                 std::vector<std::string> value_names = {}) {
    Numbers numbers;
    for (std::int32_t i = first; i <= last; ++i) numbers.push_back(i);
    arrays_.scales.push_back({name, "1", meaning, std::move(numbers), 1, std::move(value_names)});
  }

  void add_scales() {
    arrays_.scales = tally_.axes;
    if (tally_.cells.size() == tally_.cell_count()) {
      over_cells_ = names_of(tally_.axes);
    } else {
      arrays_.scales.push_back({"cell", "1", "number of the cell, the last axis runs fastest", tally_.cells});
      over_cells_ = {"cell"};
    }
    for (const CellTally& cell : tally_.tallies)
      for (const MeasureTally& measure : cell.measures)
        parts_ = std::max({parts_, measure.sum.parts().size(), measure.squares.parts().size()});
    add_scale("part", "number of the part of an exact sum", 0, static_cast<std::int32_t>(parts_) - 1);
    if (!tally_.note_kinds.empty())
      add_scale("note_kind", "kind of note on a run", 0,
                static_cast<std::int32_t>(tally_.note_kinds.size()) - 1, tally_.note_kinds);
  }

  void add_counts() {
    add_array("runs", "1", "number of runs of the cell that were made, failed ones included",
              of_cells<std::int32_t>([](const CellTally& cell) { return cell.runs(); }));
    add_array("failed", "1", "number of runs that failed",
              of_cells<std::int32_t>([](const CellTally& cell) { return cell.failed; }));
  }

  void add_notes() {
    if (tally_.note_kinds.empty()) return;
    Numbers runs;
    std::vector<std::uint64_t> first;
    for (std::size_t kind = 0; kind < tally_.note_kinds.size(); ++kind)
      for (const CellTally& cell : tally_.tallies) {
        runs.push_back(static_cast<std::int32_t>(cell.notes[kind].runs));
        first.push_back(cell.notes[kind].first);
      }
    add_array("note_runs", "1", "number of runs with a note of this kind", std::move(runs), "note_kind");
    add_array("note_first", "1", "number of the first such run; 0 without such runs", std::move(first),
              "note_kind");
  }

  void add_measure(std::size_t measure) {
    const Column& about = tally_.measures[measure];
    const auto path = [&](const char* name) { return about.name + '/' + name; };
    const auto count = [&](const char* name, const char* meaning, std::int64_t MeasureTally::*member) {
      Numbers numbers =
          of_cells<std::int32_t>([&](const CellTally& cell) { return cell.measures[measure].*member; });
      const bool is_seldom_needed = member != &MeasureTally::values;
      if (is_seldom_needed && std::count(numbers.begin(), numbers.end(), 0) == std::ssize(numbers)) return;
      add_array(path(name), "1", meaning, std::move(numbers));
    };
    const auto number = [&](const char* name, const std::string& meaning, auto&& of) {
      const auto of_values = [&](const CellTally& cell) {
        const MeasureTally& tally = cell.measures[measure];
        return tally.values == 0 ? std::numeric_limits<double>::quiet_NaN() : of(tally);
      };
      add_array(path(name), about.units, meaning, of_cells<double>(of_values));
    };
    count("values", "number of runs with a finite value", &MeasureTally::values);
    count("unknown", "number of runs whose value is unknown (NaN)", &MeasureTally::unknown);
    count("infinite", "number of runs whose value is infinite", &MeasureTally::infinite);
    number("least", "least finite value", [](const MeasureTally& tally) { return tally.least; });
    number("greatest", "greatest finite value", [](const MeasureTally& tally) { return tally.greatest; });
    number("mean", "mean of the finite values", [](const MeasureTally& tally) { return tally.mean(); });
    number("standard_deviation", "standard deviation of the finite values, with n - 1, rounded to 16 bits",
           [](const MeasureTally& tally) { return in_16_bits(tally.standard_deviation()); });
    add_sums("sum", "sum of the finite values: the exact sum of the parts", measure, &MeasureTally::sum);
    add_sums("sum_of_squares", "sum of the squares of the finite values: the exact sum of the parts", measure,
             &MeasureTally::squares);
    add_sketch(measure);
    add_events(measure);
  }

  void add_sums(const std::string& name, const std::string& meaning, std::size_t measure,
                UnroundedSum MeasureTally::*sum) {
    const std::size_t cells = tally_.tallies.size();
    std::vector<double> values(parts_ * cells, 0.0);
    for (std::size_t i = 0; i < cells; ++i) {
      const std::vector<double> parts = (tally_.tallies[i].measures[measure].*sum).parts();
      for (std::size_t part = 0; part < parts.size(); ++part) values[part * cells + i] = parts[part];
    }
    const Column& about = tally_.measures[measure];
    const std::string unit =
        sum == &MeasureTally::sum || about.units == "1" ? about.units : "(" + about.units + ")^2";
    add_array(about.name + '/' + name, unit, meaning, std::move(values), "part");
  }

  // The counts of all cells at the same distance from their medians follow each other: they are similar,
  // which makes the compressed file smaller.
  void add_sketch(std::size_t measure) {
    const std::string group = tally_.measures[measure].name;
    const std::int32_t reach = reach_of(tally_, measure);
    const std::size_t cells = tally_.cells.size();
    Numbers counts((2 * static_cast<std::size_t>(reach) + 1) * cells, 0);
    Numbers medians, far_buckets, far_counts;
    std::vector<std::uint64_t> far_cells;
    for (std::size_t i = 0; i < cells; ++i) {
      const QuantileSketch& sketch = tally_.tallies[i].measures[measure].sketch;
      medians.push_back(sketch.bucket_at(0.5));
      for (const auto& [bucket, count] : sketch.pairs()) {
        const std::int32_t row = bucket - medians.back() + reach;
        const auto values = static_cast<std::int32_t>(count);
        if (row >= 0 && row <= 2 * reach)
          counts[static_cast<std::size_t>(row) * cells + i] = values;
        else
          far_cells.push_back(tally_.cells[i]), far_buckets.push_back(bucket), far_counts.push_back(values);
      }
    }
    add_scale(group + "/bucket_offset", "number of a bucket minus that of the bucket of the median", -reach,
              reach);
    add_array(
        group + "/median_bucket", "1",
        "bucket of the median: 0 has the value 0; b > 0 the doubles whose bits >> 47 are b - 1; -b their "
        "negatives",
        std::move(medians));
    add_array(group + "/bucket_values", "1", "number of values in the bucket median_bucket + bucket_offset",
              std::move(counts), group + "/bucket_offset");
    if (far_cells.empty()) return;
    arrays_.groups.push_back({group + "/far_buckets",
                              {{"cell", "1", "number of the cell", std::move(far_cells)},
                               {"bucket", "1", "number of the bucket", std::move(far_buckets)},
                               {"values", "1", "number of values in the bucket", std::move(far_counts)}}});
  }

  void add_events(std::size_t measure) {
    const TallyLayout layout = tally_.layout();
    const auto at = std::find(layout.events.begin(), layout.events.end(), measure);
    if (at == layout.events.end()) return;
    std::vector<std::uint64_t> runs;
    for (const CellTally& cell : tally_.tallies) {
      const auto& of_cell = cell.events[static_cast<std::size_t>(at - layout.events.begin())];
      runs.insert(runs.end(), of_cell.begin(), of_cell.end());
    }
    if (runs.empty()) return;
    arrays_.groups.push_back({tally_.measures[measure].name + "/events",
                              {{"run", "1",
                                "number of a run in which the event happened: the cell times the replicates "
                                "plus the replicate",
                                std::move(runs)}}});
  }

  void add_runs() {
    std::vector<std::uint64_t> held, failed;
    std::vector<std::string> errors;
    for (const RunRange& range : tally_.held.ranges())
      held.push_back(range.first), held.push_back(range.end - 1);
    arrays_.scales.push_back(
        {"held_runs", "1", "first and last number of each range of runs that were made, one after the other",
         std::move(held)});
    for (const CellTally& cell : tally_.tallies)
      if (cell.failed > 0) failed.push_back(cell.first_failed), errors.push_back(cell.first_error);
    if (failed.empty()) return;
    arrays_.groups.push_back(
        {"errors",
         {{"run", "1", "number of the first run of a cell that failed", std::move(failed)},
          {"error", "1", "why that run failed", std::move(errors)}}});
  }

  const SweepTally& tally_;
  TallyArrays arrays_;
  std::vector<std::string> over_cells_;
  std::size_t parts_ = 1;  // largest number of parts of a sum
};
}  // namespace

bool is_free_in_tallies(const std::string& name) {
  static constexpr std::array kTaken = {"cell",      "part",       "note_kind", "runs",  "failed",
                                        "note_runs", "note_first", "held_runs", "errors"};
  return std::find(kTaken.begin(), kTaken.end(), name) == kTaken.end();
}

TallyArrays arrays_of(const SweepTally& tally) {
  return ArrayBuilder(tally).built();
}

}  // namespace remote_touch
