#include "analysis/sweeps/sweep_result.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
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

std::size_t SweepGrid::cell_count() const {
  std::size_t count = 1;
  for (const Column& axis : axes) count *= axis.length();
  return count;
}

std::vector<std::size_t> SweepGrid::axis_indices(std::size_t cell) const {
  std::vector<std::size_t> indices(axes.size());
  for (std::size_t i = axes.size(); i-- > 0; cell /= axes[i].length()) indices[i] = cell % axes[i].length();
  return indices;
}

std::size_t SweepGrid::cell_at(const std::vector<std::size_t>& indices) const {
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

SweepGrid grid_of(const SweepResult& result) {
  SweepGrid grid{result.axes, result.replicates, {}, result.note_kinds};
  for (const Column& measure : result.measures)
    grid.measures.push_back({measure.name, measure.units, measure.long_name, {}, measure.width, {}});
  return grid;
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

}  // namespace

SweepResult whole_of(SweepResult result) {
  if (!result.part) return result;
  SweepResult whole(grid_of(result));
  whole.start(!result.round.empty());
  if (result.round.empty()) whole.state.assign(whole.run_count(), RunState::elsewhere);
  for (std::size_t place = 0; place < result.held_count(); ++place)
    copy_run(result, place, whole, result.run_at(place));
  return whole;
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

namespace {

constexpr std::size_t kMaxParts = 36;

std::string text_of(const Column& axis, std::size_t index) {
  if (const auto* texts = std::get_if<std::vector<std::string>>(&axis.values)) return (*texts)[index];
  const auto number_at = [index](const auto& values) {
    if constexpr (std::is_same_v<decltype(values), const std::vector<std::string>&>)
      return 0.0;
    else
      return static_cast<double>(values[index]);
  };
  const double number = std::visit(number_at, axis.values);
  if (!axis.value_names.empty()) return axis.value_names[static_cast<std::size_t>(number)];
  char text[32];  // 6 digits: 0.3 for 0.30000000000000004
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6).ptr};
}

}  // namespace

bool Region::contains(const std::vector<std::size_t>& indices) const {
  for (std::size_t i = 0; i < ranges.size(); ++i)
    if (indices[i] < ranges[i].first || indices[i] >= ranges[i].second) return false;
  return true;
}

std::vector<Region> regions_of(const std::vector<Column>& axes) {
  std::vector<Region> parts = {{"", {}}};
  Region whole{"all runs", {}};
  for (const Column& axis : axes) {
    const std::size_t length = axis.length();
    const bool named =
        !axis.value_names.empty() || std::holds_alternative<std::vector<std::string>>(axis.values);
    whole.ranges.emplace_back(0, length);
    std::size_t count = length <= 4 ? length : length >= 6 && !named ? 3 : 1;
    if (parts.size() * count > kMaxParts) count = 1;
    std::vector<Region> finer;
    for (const Region& part : parts)
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = i * length / count, to = (i + 1) * length / count;
        finer.push_back(part);
        finer.back().ranges.emplace_back(from, to);
        if (count == 1) continue;
        std::string& label = finer.back().label;
        label += (label.empty() ? "" : ", ") + axis.name + " " + text_of(axis, from);
        if (to - from > 1) label += " to " + text_of(axis, to - 1);
      }
    parts = std::move(finer);
  }
  if (parts.size() == 1) parts.clear();
  parts.insert(parts.begin(), whole);
  return parts;
}

std::vector<CellGroup> cell_groups(const SweepGrid& grid, const std::vector<std::size_t>& axes) {
  std::size_t count = 1;
  for (const std::size_t axis : axes) count *= grid.axes[axis].length();
  std::vector<CellGroup> groups(count);
  for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
    const std::vector<std::size_t> places = grid.axis_indices(cell);
    std::size_t number = 0;
    for (const std::size_t axis : axes) number = number * grid.axes[axis].length() + places[axis];
    CellGroup& group = groups[number];
    if (group.cells.empty())
      for (const std::size_t axis : axes) group.indices.push_back(places[axis]);
    group.cells.push_back(cell);
  }
  return groups;
}

Column axis_at(const Column& axis, const std::vector<std::size_t>& places) {
  Column column = axis;
  std::visit(
      [&](auto& values) {
        auto all = std::move(values);
        values.clear();
        for (const std::size_t place : places) values.push_back(all[place]);
      },
      column.values);
  return column;
}

std::vector<Column> axes_of(const SweepGrid& grid, const std::vector<std::size_t>& axes,
                            const std::vector<CellGroup>& groups) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    std::vector<std::size_t> places;
    for (const CellGroup& group : groups) places.push_back(group.indices[i]);
    columns.push_back(axis_at(grid.axes[axes[i]], places));
  }
  return columns;
}

Values counts_in_column(const std::vector<std::int64_t>& counts) {
  const auto fits = [](std::int64_t count) { return count <= std::numeric_limits<std::int32_t>::max(); };
  if (std::ranges::all_of(counts, fits)) return std::vector<std::int32_t>(counts.begin(), counts.end());
  return std::vector<double>(counts.begin(), counts.end());
}

bool CellStreams::share_replicates(const std::vector<std::size_t>& cells) const {
  return std::ranges::any_of(cells, [&](std::size_t cell) { return draws[cell].of_replicate; });
}

bool CellStreams::are_independent(const std::vector<std::size_t>& cells) const {
  std::set<std::size_t> seen, seeds;
  for (const std::size_t cell : cells) {
    if (draws[cell].of_cell && !seen.insert(noise_cell[cell]).second) return false;
    if (draws[cell].of_replicate && !seeds.insert(seed[cell]).second) return false;
  }
  return true;
}

CellStreams independent_streams(std::size_t cells) {
  CellStreams streams;
  streams.draws.assign(cells, {true, false});
  streams.noise_cell.resize(cells), streams.seed.assign(cells, 0);
  std::iota(streams.noise_cell.begin(), streams.noise_cell.end(), std::size_t{0});
  return streams;
}

std::vector<RunCluster> clusters_of(const SweepResult& result, const CellStreams& streams,
                                    const std::vector<std::size_t>& cells, bool by_replicate) {
  std::vector<RunCluster> clusters;
  std::map<std::pair<std::size_t, int>, std::size_t> of_key;
  for (const std::size_t cell : cells)
    for (int replicate = 0; replicate < result.replicates; ++replicate) {
      const std::size_t run = result.run(cell, replicate);
      if (result.state[run] != RunState::done) continue;
      if (streams.is_fixed(cell)) {
        clusters.push_back({{run}, streams.noise_cell[cell], true});
        break;
      }
      const std::size_t key = by_replicate ? streams.seed[cell] : streams.noise_cell[cell];
      const auto [at, is_new] = of_key.try_emplace({key, replicate}, clusters.size());
      if (is_new) clusters.push_back({{}, streams.noise_cell[cell], false});
      clusters[at->second].runs.push_back(run);
    }
  return clusters;
}

std::string equal_runs_note(const CellStreams& streams, const std::vector<std::size_t>& cells,
                            const std::function<std::int64_t(std::size_t cell)>& done) {
  std::int64_t runs = 0, fixed = 0;
  for (const std::size_t cell : cells)
    if (const std::int64_t own = streams.is_fixed(cell) ? done(cell) : 0; own > 1) runs += own, ++fixed;
  if (fixed == 0) return {};
  return std::to_string(runs) + " equal runs count as " + (fixed == 1 ? "one" : std::to_string(fixed));
}

}  // namespace remote_touch
