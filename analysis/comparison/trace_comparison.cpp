#include "analysis/comparison/trace_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/trace.h"

namespace remote_touch {
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

// Returns NaN if the trace has no time at that tick.
double time_of(const ColumnSource& trace, std::size_t tick) {
  constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
  if (!trace.has("time")) return kNoTime;
  const Column time = trace.column("time");
  const auto* time_s = std::get_if<std::vector<double>>(&time.values);
  return time_s && tick < time_s->size() ? (*time_s)[tick] : kNoTime;
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
  for (const ColumnComparison& column : columns) {
    if (column.first_outside != outside) continue;
    found.quantity = column.name;
    found.deviation = deviation_at(baseline, candidate, column.name, found.tick);
    break;
  }
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

}  // namespace

const char* name_of(Cause cause) {
  constexpr const char* kNames[] = {"configuration differs", "input differs", "frame update",
                                    "state transition", "drift"};
  return kNames[static_cast<int>(cause)];
}

bool TraceComparison::is_same() const {
  const auto has_rows = [](const ColumnComparison& c) { return c.rows > 0; };
  const auto is_same = [](const ColumnComparison& c) { return c.is_same(); };
  return std::any_of(columns.begin(), columns.end(), has_rows) &&
         std::all_of(columns.begin(), columns.end(), is_same);
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

namespace {

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
    max.push_back(max_per_piece > 0 ? std::log10(max_per_piece) : std::numeric_limits<double>::quiet_NaN());
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
  const bool is_inside = std::all_of(comparison.columns.begin(), comparison.columns.end(),
                                     [](const ColumnComparison& column) { return column.is_same(); });
  return std::to_string(count) + " column(s) differ" + (is_inside ? ", within the tolerances." : ".");
}

bool has_time(const ColumnSource& trace) {
  return trace.has("time") && std::holds_alternative<std::vector<double>>(trace.column("time").values);
}

}  // namespace

Figure deviation_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                        const TraceComparison& comparison) {
  Figure figure{"deviation", "Deviation of two traces over time", caption_of(comparison)};
  if (!has_time(baseline)) {
    if (std::any_of(comparison.columns.begin(), comparison.columns.end(), differs))
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
