#include "analysis/storage/trace_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/columns.h"

namespace remote_touch {

bool ColumnSource::has(const std::string& name) const {
  return std::ranges::count(column_names(), name) > 0;
}

StoredTrace::StoredTrace(Hdf5Reader hdf5) : StoredColumns(std::move(hdf5), "/trace/") {
  hdf5_.require_kind("trace", "a trace of remote-touch run or replay");
  column_names_ = split_names(attribute(hdf5_.attributes(), "columns"));
}

std::vector<std::uint64_t> StoredTrace::running_hash() const {
  return hdf5_.values<std::uint64_t>(group_ + kRunningHash);
}

StoredFigure::StoredFigure(Hdf5Reader hdf5) : StoredColumns(std::move(hdf5), "/tables/") {
  hdf5_.require_kind("figure", "a figure of remote-touch figure");
  for (const std::string& path : hdf5_.datasets())
    if (path.starts_with(group_)) column_names_.push_back(path.substr(group_.size()));
}

const Column& ColumnsInMemory::find(const std::string& name) const {
  for (const Column& column : all_)
    if (column.name == name) return column;
  throw std::out_of_range("no column " + name);
}

Column ColumnsInMemory::rows(const std::string& name, std::size_t first, std::size_t count) const {
  Column some = find(name);
  const auto width = static_cast<std::ptrdiff_t>(some.width);
  std::visit(
      [&](auto& values) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first) * width;
        values = std::decay_t<decltype(values)>(begin, begin + static_cast<std::ptrdiff_t>(count) * width);
      },
      some.values);
  return some;
}

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

std::string extent(const Column& column) {
  return std::to_string(column.length()) + " rows of " + std::to_string(column.width);
}

// Returns in words the first mismatch of the two columns; empty if there is none.
std::string mismatch(const Column& a, const Column& b) {
  if (a.values.index() != b.values.index()) return "different type of values";
  if (a.width != b.width || a.length() != b.length()) return extent(a) + " against " + extent(b);
  if (a.units != b.units) return "units " + a.units + " against " + b.units;
  if (a.value_names != b.value_names) return "different names of the values";
  return {};
}

double deviation(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double difference = b - a;
  return std::isfinite(difference) ? difference : kNotANumber;
}

// Length of a row of differences or values; 0 only if all are 0. It is computed in units of the largest one
// if the squares would over- or underflow.
template <class Component>
double length(std::size_t width, Component&& component) {
  if (width == 1) return std::abs(component(0));
  double squares = 0;
  for (std::size_t k = 0; k < width; ++k) squares += component(k) * component(k);
  if ((squares > 1e-280 && squares < 1e280) || std::isnan(squares)) return std::sqrt(squares);
  double max = 0;
  for (std::size_t k = 0; k < width; ++k) max = std::max(max, std::abs(component(k)));
  if (max == 0 || std::isinf(max)) return max;
  squares = 0;
  for (std::size_t k = 0; k < width; ++k) squares += (component(k) / max) * (component(k) / max);
  return max * std::sqrt(squares);
}

template <class Number>
double row_deviation(const Number* a, const Number* b, std::size_t width) {
  if (std::equal(a, a + width, b)) return 0;
  return length(width, [&](std::size_t k) { return deviation(a[k], b[k]); });
}

// False for names, texts and hashes, which are only equal or not.
bool has_deviations(const Column& column) {
  return std::holds_alternative<std::vector<double>>(column.values) ||
         (std::holds_alternative<std::vector<std::int32_t>>(column.values) && column.value_names.empty());
}

// Calls visit(row, deviation) for every row that both columns have.
template <class Visit>
void for_rows(const Column& baseline, const Column& candidate, Visit&& visit) {
  if (baseline.values.index() != candidate.values.index() || baseline.width != candidate.width) return;
  const std::size_t rows = std::min(baseline.length(), candidate.length());
  const auto width = static_cast<std::size_t>(baseline.width);
  std::visit(
      [&](const auto& a) {
        using Numbers = std::decay_t<decltype(a)>;
        const auto& b = std::get<Numbers>(candidate.values);
        for (std::size_t i = 0; i < rows; ++i) {
          const auto *x = &a[i * width], *y = &b[i * width];
          if constexpr (std::is_arithmetic_v<typename Numbers::value_type>)
            visit(i, has_deviations(baseline)      ? row_deviation(x, y, width)
                     : std::equal(x, x + width, y) ? 0
                                                   : 1);
          else
            visit(i, std::equal(x, x + width, y) ? 0 : 1);
        }
      },
      baseline.values);
}

// Length of a row of the baseline; 0 for texts and hashes, which have no length.
double length_of(const Column& column, std::size_t row) {
  const auto* numbers = std::get_if<std::vector<double>>(&column.values);
  const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values);
  const auto width = static_cast<std::size_t>(column.width);
  return length(width, [&](std::size_t k) -> double {
    return numbers ? (*numbers)[row * width + k] : integers ? (*integers)[row * width + k] : 0;
  });
}

// The relative tolerance allows nothing if the baseline's row has no finite length.
double allowed(const Column& baseline, std::size_t row, const Tolerance& tolerance) {
  if (tolerance.relative == 0) return tolerance.absolute;
  const double size = length_of(baseline, row);
  return tolerance.absolute + (std::isfinite(size) ? tolerance.relative * size : 0);
}

}  // namespace

ColumnComparison compare_columns(const Column& baseline, const Column& candidate,
                                 const Tolerance& tolerance) {
  ColumnComparison result{baseline.name, baseline.units, tolerance, mismatch(baseline, candidate)};
  result.baseline_rows = baseline.length(), result.candidate_rows = candidate.length();
  const bool measured = has_deviations(baseline);
  double squares = 0;
  std::size_t finite = 0;
  for_rows(baseline, candidate, [&](std::size_t row, double deviation) {
    ++result.rows;
    finite += std::isfinite(deviation) ? 1 : 0;
    if (deviation == 0) return;
    if (!result.first_difference) result.first_difference = row;
    const bool inside = measured && deviation <= allowed(baseline, row, tolerance);
    if (std::isnan(deviation))
      ++result.not_numbers;
    else if (measured)
      result.max = std::max(result.max, deviation), squares += deviation * deviation;
    if (inside) return;
    ++result.outside;
    if (!result.first_outside) result.first_outside = row;
  });
  if (finite > 0) result.rms = std::sqrt(squares / static_cast<double>(finite));
  return result;
}

std::vector<double> deviations(const Column& baseline, const Column& candidate) {
  std::vector<double> all;
  for_rows(baseline, candidate, [&](std::size_t, double deviation) { all.push_back(deviation); });
  return all;
}

TickHashes hashes_of_trace(const StoredTrace& trace, int every) {
  const std::vector<std::uint64_t> all = trace.running_hash();
  TickHashes some;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % static_cast<std::size_t>(every) != 0 && i + 1 != all.size()) continue;
    some.tick.push_back(static_cast<std::int32_t>(i));
    some.hash.push_back(all[i]);
  }
  return some;
}

void write_hashes(const std::filesystem::path& file, const TickHashes& hashes,
                  const TextAttributes& provenance) {
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", schema_name("hashes"));
  hdf5.attributes("/", provenance);
  hdf5.group("/hashes");
  hdf5.columns("/hashes",
               {{"tick", "1", "number of the haptic tick", hashes.tick},
                {"tick_hash", "1", "64-bit hash of all columns up to this tick", hashes.hash}},
               "tick");
  hdf5.save(file);
}

StoredHashes read_hashes(const Hdf5Reader& hdf5) {
  hdf5.require_kind("hashes", "the result of remote-touch hashes");
  StoredHashes stored{
      {hdf5.values<std::int32_t>("/hashes/tick"), hdf5.values<std::uint64_t>("/hashes/tick_hash")},
      hdf5.attributes()};
  const std::vector<std::int32_t>& tick = stored.hashes.tick;
  if (tick.size() != stored.hashes.hash.size()) hdf5.damaged("its ticks and hashes differ in number");
  for (std::size_t i = 0; i < tick.size(); ++i)
    if (tick[i] < 0 || (i > 0 && tick[i] <= tick[i - 1])) hdf5.damaged("its ticks are out of order");
  return stored;
}

HashComparison compare_hashes(const TickHashes& baseline, const TickHashes& candidate) {
  HashComparison result;
  result.same_length =
      !baseline.tick.empty() && !candidate.tick.empty() && baseline.tick.back() == candidate.tick.back();
  for (std::size_t i = 0, j = 0; i < baseline.tick.size() && j < candidate.tick.size();) {
    if (baseline.tick[i] < candidate.tick[j]) {
      ++i;
    } else if (baseline.tick[i] > candidate.tick[j]) {
      ++j;
    } else {
      ++result.compared;
      const int tick = baseline.tick[i];
      const bool same = baseline.hash[i++] == candidate.hash[j++];
      if (same)
        result.same = tick;
      else if (!result.different)
        result.different = tick;
    }
  }
  return result;
}

namespace {

std::optional<std::size_t> earlier(std::optional<std::size_t> a, std::optional<std::size_t> b) {
  return a && b ? std::min(a, b) : a ? a : b;
}

bool is_input(const std::string& column) {
  return column == "time" || column == "hip_position" || column == "hip_orientation" ||
         column == "frame_hash";
}

// The tick at which the two runs begin to differ, and the rows around it.
class PartingTick {
 public:
  PartingTick(const ColumnSource& baseline, const ColumnSource& candidate,
              const std::vector<ColumnComparison>& columns, std::size_t tick)
      : baseline_(baseline), candidate_(candidate), columns_(columns), tick_(tick) {}

  // Returns the situation at that tick, and one line with its reason.
  std::pair<Cause, std::string> situation() const {
    const std::vector<std::string> inputs = differing_inputs();
    if (!inputs.empty()) return {Cause::input, joined(inputs, ", ")};
    if (differs("frame_index"))
      return {Cause::frame_update, "both received the same frames, but one did not use the newest"};
    if (new_frame(baseline_) || new_frame(candidate_))
      return {Cause::frame_update,
              "frame " + std::to_string(frame(baseline_, tick_)) + " arrived in this tick, the same in both"};
    if (differs("state") || changed(baseline_, "state") || changed(candidate_, "state"))
      return {Cause::state_transition, "baseline " + states(baseline_) + ", candidate " + states(candidate_)};
    return {Cause::drift, "no frame arrived and the state, " + state(baseline_, tick_) + ", did not change"};
  }

  std::string frame_text() const {
    if (!integer(baseline_, "frame_index", tick_)) return "unknown: the traces have no frame_index here";
    const Column frames = baseline_.column("frame_index");
    const auto& index = std::get<std::vector<std::int32_t>>(frames.values);
    if (index[tick_] < 0) return "no frame had arrived yet";
    std::size_t since = tick_, next = tick_ + 1;
    while (since > 0 && index[since - 1] == index[tick_]) --since;
    while (next < index.size() && index[next] == index[tick_]) ++next;
    std::string text = "frame " + std::to_string(index[tick_]) + " since tick " + std::to_string(since);
    if (next < index.size())
      text += ", frame " + std::to_string(index[next]) + " with tick " + std::to_string(next);
    return text;
  }

 private:
  bool differs(const std::string& column) const {
    for (const ColumnComparison& comparison : columns_)
      if (comparison.name == column) return comparison.first_difference == tick_;
    return false;
  }
  std::vector<std::string> differing_inputs() const {
    std::vector<std::string> inputs;
    for (const ColumnComparison& comparison : columns_)
      if (is_input(comparison.name) && differs(comparison.name)) inputs.push_back(comparison.name);
    // If the distance to the truth differs at the same proxy position, the truth itself differs.
    if (inputs.empty() && differs("signed_distance") && !differs("proxy_position"))
      inputs.emplace_back("signed_distance (the true surface)");
    return inputs;
  }
  // Returns std::nullopt if one of the traces has no such column or no row for that tick, or if the values
  // are not integers.
  std::optional<std::int32_t> integer(const ColumnSource& trace, const char* column, std::size_t tick) const {
    for (const ColumnComparison& comparison : columns_) {
      if (comparison.name != column || comparison.rows <= tick) continue;
      const Column row = trace.rows(column, tick, 1);
      if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&row.values)) return integers->at(0);
    }
    return {};
  }
  std::int32_t frame(const ColumnSource& trace, std::size_t tick) const {
    return integer(trace, "frame_index", tick).value_or(-1);
  }
  bool changed(const ColumnSource& trace, const char* column) const {
    const auto now = integer(trace, column, tick_);
    return now && tick_ > 0 && now != integer(trace, column, tick_ - 1);
  }
  // The very first tick with a frame is an update too.
  bool new_frame(const ColumnSource& trace) const {
    return tick_ > 0 ? changed(trace, "frame_index") : frame(trace, 0) >= 0;
  }
  std::string state(const ColumnSource& trace, std::size_t tick) const {
    const auto number = integer(trace, "state", tick);
    if (!number) return "unknown";
    const Column row = trace.rows("state", tick, 1);
    const auto place = static_cast<std::size_t>(*number);
    return place < row.value_names.size() ? row.value_names[place] : std::to_string(*number);
  }
  std::string states(const ColumnSource& trace) const {
    return (tick_ > 0 ? state(trace, tick_ - 1) + " to " : "") + state(trace, tick_);
  }

  const ColumnSource& baseline_;
  const ColumnSource& candidate_;
  const std::vector<ColumnComparison>& columns_;
  std::size_t tick_;
};

double deviation_at(const ColumnSource& baseline, const ColumnSource& candidate, const std::string& column,
                    std::size_t tick) {
  return deviations(baseline.rows(column, tick, 1), candidate.rows(column, tick, 1)).at(0);
}

bool has_time(const ColumnSource& trace) {
  return trace.has("time") && std::holds_alternative<std::vector<double>>(trace.column("time").values);
}

// Returns NaN if the trace has no time at that tick.
double time_of(const ColumnSource& trace, std::size_t tick) {
  if (!has_time(trace)) return kNotANumber;
  const Column time = trace.column("time");
  const auto& time_s = std::get<std::vector<double>>(time.values);
  return tick < time_s.size() ? time_s[tick] : kNotANumber;
}

std::optional<Divergence> find_divergence(const ColumnSource& baseline, const ColumnSource& candidate,
                                          const std::vector<ColumnComparison>& columns,
                                          const std::vector<std::string>& configuration) {
  std::optional<std::size_t> outside, first_difference;
  for (const ColumnComparison& column : columns) {
    outside = earlier(outside, column.first_outside);
    first_difference = earlier(first_difference, column.first_difference);
  }
  if (!outside) return {};
  Divergence found;
  found.tick = *outside, found.first_difference = *first_difference;
  found.quantity = std::ranges::find(columns, outside, &ColumnComparison::first_outside)->name;
  found.deviation = deviation_at(baseline, candidate, found.quantity, found.tick);
  found.time_s = time_of(baseline, found.tick);
  const PartingTick parting(baseline, candidate, columns, found.first_difference);
  std::tie(found.situation, found.observation) = parting.situation();
  found.cause = configuration.empty() ? found.situation : Cause::configuration;
  found.explanation = configuration.empty() ? found.observation : joined(configuration, ", ");
  found.frame = parting.frame_text();
  found.first_row = found.first_difference > 0 ? found.first_difference - 1 : 0;
  for (const ColumnComparison& column : columns) {
    if (column.rows <= found.first_difference) continue;
    const std::size_t count = found.first_difference - found.first_row + 1;
    found.baseline.push_back(baseline.rows(column.name, found.first_row, count));
    found.candidate.push_back(candidate.rows(column.name, found.first_row, count));
  }
  return found;
}

constexpr std::size_t kMaxPieces = 2000, kMaxPanels = 8;

// Returns the logarithm of the largest deviation in each piece. Names, texts and hashes deviate by 0 or 1. A
// row with a NaN against a number is skipped.
Table pieces(const std::string& column, const std::vector<double>& time,
             const std::vector<double>& deviation) {
  std::vector<double> when, max;
  const std::size_t rows = std::min(time.size(), deviation.size());
  const std::size_t length = (rows + kMaxPieces - 1) / kMaxPieces;
  for (std::size_t first = 0; first < rows; first += length) {
    double max_per_piece = 0;
    for (std::size_t i = first; i < std::min(rows, first + length); ++i)
      max_per_piece = std::max(max_per_piece, std::isnan(deviation[i]) ? 0 : deviation[i]);
    when.push_back(time[first]);
    max.push_back(max_per_piece > 0 ? std::log10(max_per_piece) : kNotANumber);
  }
  Table table{column, "Deviation of " + column};
  table.add("time", "s", "simulated time, beginning of the piece", std::move(when));
  table.add("deviation", "1", "log10 of the largest deviation in the column's units", std::move(max));
  return table;
}

bool differs(const ColumnComparison& column) {
  return column.first_difference || !column.is_same();
}

std::string caption_of(const TraceComparison& comparison) {
  if (comparison.divergence)
    return "First divergent tick " + std::to_string(comparison.divergence->tick) + ", " +
           comparison.divergence->quantity + ": " + name_of(comparison.divergence->cause) + ", " +
           comparison.divergence->explanation + ".";
  const auto count = std::count_if(comparison.columns.begin(), comparison.columns.end(), differs);
  if (count == 0) return "No column differs.";
  const bool is_inside = std::ranges::all_of(comparison.columns, &ColumnComparison::is_same);
  return std::to_string(count) + " column(s) differ" + (is_inside ? ", within the tolerances." : ".");
}

}  // namespace

const char* name_of(Cause cause) {
  constexpr const char* kNames[] = {"configuration differs", "input differs", "frame update",
                                    "state transition", "drift"};
  return kNames[static_cast<int>(cause)];
}

bool TraceComparison::is_same() const {
  return std::ranges::any_of(columns, [](const ColumnComparison& c) { return c.rows > 0; }) &&
         std::ranges::all_of(columns, &ColumnComparison::is_same);
}

TraceComparison compare_by_name(const ColumnSource& baseline, const ColumnSource& candidate,
                                const Tolerances& tolerances, const std::vector<std::string>& configuration) {
  TraceComparison result;
  const auto add_missing = [&](const Column& column, const std::string& name, const char* where) {
    result.columns.push_back({name, column.units, tolerance_of(tolerances, name)});
    result.columns.back().problem = where;
  };
  for (const std::string& name : baseline.column_names()) {
    if (name == kRunningHash) continue;
    const Column ours = baseline.column(name);
    if (candidate.has(name)) {
      result.columns.push_back(compare_columns(ours, candidate.column(name), tolerance_of(tolerances, name)));
      result.columns.back().name = name;  // a figure's column is named with its table
    } else {
      add_missing(ours, name, "missing in the candidate");
    }
  }
  for (const std::string& name : candidate.column_names()) {
    if (name == kRunningHash || baseline.has(name)) continue;
    if (configuration.empty())
      result.added.push_back(name);
    else
      add_missing(candidate.column(name), name, "missing in the baseline");
  }
  return result;
}

TraceComparison compare_traces(const ColumnSource& baseline, const ColumnSource& candidate,
                               const Tolerances& tolerances, const std::vector<std::string>& configuration) {
  TraceComparison result = compare_by_name(baseline, candidate, tolerances, configuration);
  result.divergence = find_divergence(baseline, candidate, result.columns, configuration);
  return result;
}

Figure deviation_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                        const TraceComparison& comparison) {
  Figure figure{"deviation", "Deviation of two traces over time", caption_of(comparison)};
  if (!has_time(baseline)) {
    if (std::ranges::any_of(comparison.columns, differs))
      figure.caption += " Nothing is drawn, because the baseline has no column time.";
    return figure;
  }
  const Column time = baseline.column("time");
  const auto& time_s = std::get<std::vector<double>>(time.values);
  for (const ColumnComparison& column : comparison.columns) {
    if (!column.first_difference || figure.panels.size() == kMaxPanels) continue;
    const Column ours = baseline.column(column.name);
    figure.tables.push_back(pieces(column.name, time_s, deviations(ours, candidate.column(column.name))));
    Table first{column.name + "_first", "First row outside"};
    if (column.first_outside && *column.first_outside < time_s.size()) {
      const double size = deviations(baseline.rows(column.name, *column.first_outside, 1),
                                     candidate.rows(column.name, *column.first_outside, 1))
                              .front();
      first.add("time", "s", "simulated time", {time_s[*column.first_outside]});
      first.add("deviation", "1", "log10 of the deviation", {std::log10(size)});
    }
    const std::string unit = column.units == "1" ? "" : " in " + column.units;
    Panel panel{column.name, "time (s)", "log10 of the deviation" + unit};
    panel.curves.push_back({column.name, "time", "deviation", CurveStyle::line});
    if (!first.columns.empty() && std::isfinite(std::get<std::vector<double>>(first.columns[1].values)[0])) {
      figure.tables.push_back(first);
      panel.curves.push_back({first.name, "time", "deviation", CurveStyle::dots, "first outside"});
    }
    figure.panels.push_back(panel);
  }
  return figure;
}

}  // namespace remote_touch
