#include "analysis/comparison/deviation_figure.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

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
