#include "runners/sweep/stored_sweep.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/contact_measures.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/simulation/run_notes.h"

namespace remote_touch {

namespace {

[[noreturn]] void refuse_cell(const NamedCell& cell, const std::string& expected) {
  throw InputError(cell.option + " " + cell.text, "expected " + expected);
}

std::vector<std::string> items_of(const std::string& text) {
  std::vector<std::string> items;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    items.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return items;
}

// Returns the value of a row as the user writes it.
std::string value_text(const Column& axis, std::size_t row) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&axis.values))
    return formatted("%.6g", (*numbers)[row]);
  const auto number = std::get<std::vector<std::int32_t>>(axis.values)[row];
  return axis.value_names.empty() ? std::to_string(number)
                                  : axis.value_names[static_cast<std::size_t>(number)];
}

std::string values_text(const Column& axis) {
  constexpr std::size_t kMax = 12;
  std::string text;
  for (std::size_t row = 0; row < std::min(kMax, axis.length()); ++row)
    text.append(row == 0 ? "" : ", ").append(value_text(axis, row));
  if (axis.length() > kMax) text += " ... " + value_text(axis, axis.length() - 1);
  return text;
}

std::optional<double> number_of(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

// Returns the row whose value is exactly this number, if the axis has numbers with a fraction.
std::optional<std::size_t> exact_row_of(const Column& axis, double number) {
  const auto* const numbers = std::get_if<std::vector<double>>(&axis.values);
  if (!numbers) return {};
  const auto same = std::find(numbers->begin(), numbers->end(), number);
  if (same == numbers->end()) return {};
  return static_cast<std::size_t>(same - numbers->begin());
}

// Returns the rows that have this text.
std::vector<std::size_t> rows_with(const Column& axis, const std::string& text) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < axis.length(); ++row)
    if (value_text(axis, row) == text) rows.push_back(row);
  return rows;
}

// Returns the rows that the text may name: one, unless no value or several values fit.
std::vector<std::size_t> rows_of(const Column& axis, const std::string& value) {
  const std::optional<double> number = number_of(value);
  if (!number) return rows_with(axis, value);
  if (const std::optional<std::size_t> row = exact_row_of(axis, *number)) return {*row};
  const std::vector<std::size_t> same_text = rows_with(axis, value);
  return same_text.empty() ? rows_with(axis, formatted("%.6g", *number)) : same_text;
}

std::size_t row_of(const NamedCell& cell, const Column& axis, const std::string& value) {
  const std::vector<std::size_t> rows = rows_of(axis, value);
  if (rows.empty()) refuse_cell(cell, "for " + axis.name + " one of " + values_text(axis));
  if (rows.size() > 1)
    refuse_cell(cell, "for " + axis.name + " a number with more digits, or the indices on the axes: " +
                          std::to_string(rows.size()) + " values are " + value_text(axis, rows.front()) +
                          " with six digits");
  return rows.front();
}

// Splits "NAME=VALUE,NAME=VALUE" at the commas before the name of an axis. Other commas belong to a value:
// that of an axis of objects is JSON.
std::vector<std::string> assignments_of(const std::string& text, const std::vector<Column>& axes) {
  std::vector<std::string> assignments;
  for (const std::string& item : items_of(text)) {
    const bool begins = std::any_of(axes.begin(), axes.end(),
                                    [&](const Column& axis) { return item.starts_with(axis.name + "="); });
    if (begins || assignments.empty())
      assignments.push_back(item);
    else
      assignments.back() += "," + item;
  }
  return assignments;
}

// Returns the cell of a text with NAME=VALUE for each axis, in any order.
std::size_t cell_by_values(const NamedCell& cell, const SweepGrid& grid) {
  std::vector<std::optional<std::size_t>> indices(grid.axes.size());
  bool are_known = true;
  for (const std::string& item : assignments_of(cell.text, grid.axes)) {
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string name = item.substr(0, equals), value = item.substr(std::min(equals + 1, item.size()));
    const auto axis = std::find_if(grid.axes.begin(), grid.axes.end(),
                                   [&](const Column& each) { return each.name == name; });
    const auto i = static_cast<std::size_t>(axis - grid.axes.begin());
    are_known = axis != grid.axes.end() && !indices[i];
    if (!are_known) break;
    indices[i] = row_of(cell, *axis, value);
  }
  std::string names;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    names.append(names.empty() ? "" : ",").append(grid.axes[i].name + "=VALUE");
    if (indices[i]) found.push_back(*indices[i]);
  }
  if (!are_known || found.size() != indices.size()) refuse_cell(cell, names);
  return grid.cell_at(found);
}

}  // namespace

std::string cell_text(const SweepGrid& grid, std::size_t cell) {
  std::string text;
  for (const std::size_t at : grid.axis_indices(cell))
    text.append(text.empty() ? "" : ",").append(std::to_string(at));
  return text;
}

std::size_t cell_of(const NamedCell& cell, const SweepGrid& grid) {
  if (cell.text.find('=') != std::string::npos) return cell_by_values(cell, grid);
  std::string allowed;
  for (const Column& axis : grid.axes)
    allowed.append(allowed.empty() ? "0.." : ",0..").append(std::to_string(axis.length() - 1));
  std::vector<std::size_t> indices;
  for (const std::string& item : items_of(cell.text)) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), number);
    if (error != std::errc() || end != item.data() + item.size() || indices.size() == grid.axes.size() ||
        number >= grid.axes[indices.size()].length())
      refuse_cell(cell, allowed);
    indices.push_back(number);
  }
  if (indices.size() != grid.axes.size()) refuse_cell(cell, allowed);
  return grid.cell_at(indices);
}

namespace {

// pre: the distance that judges the run is unknown in some tick, as in every run with a frame whose outcome
// is unknown.
std::string text_of_unknown_outcome(const Trace& trace) {
  const std::vector<double>& distance_m = judged_distance_m(trace);
  std::size_t unknown = 0, last = 0;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (std::isnan(distance_m[i])) last = i, ++unknown;
  return formatted(
      "it is not known whether the %s popped through: its distance to the %s surface is unknown in "
      "%.3g %% of the ticks, last at %.6g s, beside an object or at a depth edge for example; choose a "
      "larger scene, or a hand that stays over it",
      trace.has_tool() ? "tool" : "proxy", trace.has_measured_surface() ? "measured" : "true",
      100 * static_cast<double>(unknown) / static_cast<double>(trace.length()), trace.time_s[last]);
}

}  // namespace

std::string option_of_run(const SweepGrid& grid, std::size_t run) {
  std::string option = "--cell " + cell_text(grid, grid.cell_of(run));
  if (grid.replicates > 1) option += " --replicate " + std::to_string(grid.replicate_of(run));
  return option;
}

std::vector<std::string> note_lines(const SweepResult& result) {
  return note_lines(result, note_counts(result), result.runs_in(RunState::done).size());
}

std::vector<std::string> note_lines(const SweepGrid& grid, const std::vector<NoteCount>& counts,
                                    std::size_t done) {
  std::vector<std::string> lines;
  for (const NoteCount& count : counts)
    lines.push_back(std::to_string(count.runs) + " of " + std::to_string(done) + " runs: " +
                    text_of_kind(count.kind) + " (the first: " + option_of_run(grid, count.first) + ")");
  return lines;
}

std::vector<std::string> note_lines(const SweepTally& tally) {
  const CellTally all = tally.over_all_cells();
  std::vector<NoteCount> counts;
  for (std::size_t i = 0; i < all.notes.size(); ++i)
    if (all.notes[i].runs > 0)
      counts.push_back({tally.note_kinds[i], static_cast<std::size_t>(all.notes[i].runs),
                        static_cast<std::size_t>(all.notes[i].first)});
  return note_lines(tally, counts, static_cast<std::size_t>(all.done));
}

void refuse_notes(const std::vector<std::string>& lines) {
  if (!lines.empty()) throw InputError("--strict", joined(lines, "; "));
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

namespace {

constexpr std::size_t kMaxRunsInMemory = 10'000'000;

// Throws InputError for a part of a sweep that has more runs than an array in memory should have.
StoredSweep whole(StoredSweep stored, const std::string& file) {
  if (stored.result.part && stored.result.run_count() > kMaxRunsInMemory)
    throw InputError(file, "holds " + std::to_string(stored.result.held_count()) + " of the " +
                               std::to_string(stored.result.run_count()) +
                               " runs of its sweep: expected a whole sweep, or one of at most " +
                               std::to_string(kMaxRunsInMemory) + " runs");
  stored.result = whole_of(std::move(stored.result));
  return stored;
}

}  // namespace

StoredSweep read_stored_sweep(const Hdf5Reader& file) {
  return whole(read_sweep(file), file.file());
}

StoredSweep read_stored_sweep(const std::filesystem::path& file) {
  return whole(read_sweep(file), file.string());
}

std::string damage_text(const StoredSweep& stored) {
  if (stored.damaged_runs == 0) return "";
  const bool is_one = stored.damaged_runs == 1;
  return std::to_string(stored.damaged_runs) + (is_one ? " run has" : " runs have") +
         " a wrong checksum, because of a partial write or damage: " + (is_one ? "it is" : "they are") +
         " left out, and the command of the sweep makes " + (is_one ? "it" : "them") + " again";
}

KeptSweep read_kept_sweep(const std::filesystem::path& file, Extent extent) {
  if (const Hdf5Reader reader(file); is_tally(reader)) {
    StoredTally stored = read_tally(reader);
    const std::string warning = distrust_of(stored.attributes);
    return {std::move(stored.tally), std::move(stored.attributes), warning};
  }
  StoredSweep stored = extent == Extent::whole ? read_stored_sweep(file) : read_sweep(file);
  const std::string warning = damage_text(stored);
  return {std::move(stored.result), std::move(stored.attributes), warning};
}

std::size_t count_of(const SweepResult& result, RunState state) {
  return static_cast<std::size_t>(std::count(result.state.begin(), result.state.end(), state));
}

std::size_t count_of(const SweepTally& tally, RunState state) {
  std::int64_t runs = 0;
  for (const CellTally& cell : tally.tallies)
    runs += state == RunState::done ? cell.done : state == RunState::failed ? cell.failed : 0;
  return static_cast<std::size_t>(runs);
}

}  // namespace remote_touch
