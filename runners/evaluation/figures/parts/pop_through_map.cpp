#include "runners/evaluation/figures/parts/pop_through_map.h"

#include <algorithm>
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

std::string seed_setting(int seed) {
  return "seed=" + std::to_string(seed);
}

std::vector<double> known_pop_throughs(FigureContext& context, const std::vector<Experiment>& lifts) {
  std::vector<double> popped = context.measure(lifts, popped_through);
  if (std::ranges::any_of(popped, [](double lift) { return std::isnan(lift); }))
    throw InputError("popped_through",
                     "is unknown for a lift of a figure: expected a known surface below it");
  return popped;
}

double survived_share(FigureContext& context, const std::vector<Experiment>& lifts) {
  return 1 - mean(context.measure(lifts, popped_through));
}

double share_of_known(const std::vector<double>& survived) {
  constexpr double kMostUnknown = 0.01;
  std::vector<double> known = survived;
  std::erase_if(known, [](double share) { return std::isnan(share); });
  const auto all = static_cast<double>(survived.size()), left = static_cast<double>(known.size());
  return all - left <= kMostUnknown * all ? mean(known) : kNoValue;
}

Table noise_table(const std::string& name, const std::string& title) {
  TableRows rows;
  for (int i = 0; i <= 150; ++i) rows.push_back({0.02 * i});
  return table_of(name, title, {kNoiseColumn}, rows);
}

Table map_table(const std::string& name, const SweepResult& result) {
  const std::vector<double>& popped = result.measure("popped_through");
  TableRows rows;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    const EventCounts lifts = event_counts(result, popped, cell);
    const Estimate survived = estimated_fraction(EventCounts{lifts.without, lifts.events, lifts.unknown});
    rows.push_back({axis_value(result, 0, cell) / kContactRadius_m,
                    axis_value(result, 1, cell) / kContactRadius_m, survived.value, survived.low,
                    survived.high, static_cast<double>(lifts.runs())});
  }
  return table_of(name, "lifts that did not pop through",
                  {kNoiseColumn,
                   kAccelerationColumn,
                   {"survived", "1", "share of lifts that did not pop through"},
                   {"survived_low", "1", "lower end of its 95 % interval"},
                   {"survived_high", "1", "upper end of its 95 % interval"},
                   {"runs", "1", "number of lifts"}},
                  rows);
}

Table region_table(const std::string& name, const Table& map) {
  constexpr double kNoise[] = {0, 0.5, 1, 1.5, 2, 3.001}, kAcceleration[] = {0, 300, 600, 898, 1150, 1e9};
  const auto &x = numbers(map, "noise"), &y = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  // A node on an edge belongs to the region above it, whatever its last bit.
  constexpr double kEdge = 1e-9;
  TableRows rows;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      std::vector<double> inside;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const bool in_column = x[i] + kEdge >= kNoise[column] && x[i] + kEdge < kNoise[column + 1];
        const bool in_row = y[i] + kEdge >= kAcceleration[row] && y[i] + kEdge < kAcceleration[row + 1];
        if (in_column && in_row) inside.push_back(survived[i]);
      }
      rows.push_back({kNoise[column], kAcceleration[row], share_of_known(inside)});
    }
  return table_of(name, "success by region",
                  {{"noise_from", "r_c", "lower edge of the region"},
                   {"acceleration_from", "r_c/s^2", "lower edge of the region"},
                   {"survived", "1", "share of lifts that did not pop through"}},
                  rows);
}

double SharedLifts::standard_error(double our_lifts_a_node) const {
  const double lifts = nodes * lifts_a_node, at_least = (variance * lifts + 1) / (lifts + 1);
  return std::sqrt(at_least / nodes * (1 / lifts_a_node + 1 / our_lifts_a_node));
}

void claim_agrees(const Claims& claims, const std::string& claim, double measured, const SharedLifts& other,
                  double our_lifts_a_node, const std::string& paper) {
  const double slack = kByChance * other.standard_error(our_lifts_a_node);
  claims.between(claim, measured, std::max(0.0, other.survived - slack),
                 std::min(1.0, other.survived + slack), "fraction", paper);
}

double max_apart(const Table& table) {
  const std::vector<double>& values = numbers(table, "difference_in_standard_errors");
  double max = values.empty() ? std::nan("") : 0;  // nothing that was compared is no agreement
  for (const double apart : values) max = max_or_nan(max, std::abs(apart));
  return max;
}

SharedLifts second_fraction(const std::string& place) {
  const auto number = [&](const char* what) { return second_number("chapter_4", place + "/" + what); };
  return {number("survived"), number("variance"), number("nodes"), 1};
}

Table survivors(const std::string& name, const Table& map) {
  const auto &x = numbers(map, "noise"), &y = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  TableRows rows;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (survived[i] > 0.5) rows.push_back({x[i], y[i]});
  return table_of(name, "cells whose lift did not pop through", {kNoiseColumn, kAccelerationColumn}, rows);
}

void add_bound(Table& table, const std::string& column, const std::string& meaning,
               const std::function<double(double noise_m)>& bound_m_per_s2) {
  std::vector<double> bound;
  for (const double noise : numbers(table, "noise"))
    bound.push_back(bound_m_per_s2(noise * kContactRadius_m) / kContactRadius_m);
  table.add(column, "r_c/s^2", meaning, bound);
}

double printed_bound(double noise_m) {
  return bound_acceleration(kLift, printed_thickness().at(noise_m), printed_normal_error().at(noise_m));
}

Table bound_table() {
  Table table = noise_table("bound", "bound on pop-through");
  add_bound(table, "printed", "(4.25) with (4.23) and (4.24) as printed", printed_bound);
  return table;
}

Panel map_panel(const std::string& title, std::vector<Curve> curves) {
  return plot(title, "noise (r_c)", "acceleration (r_c/s^2)", std::move(curves),
              {.x_range = {{-0.02, 3.02}}, .y_range = {{-10, 1410}}});
}

Panel survivor_panel(const std::string& title, const std::string& table, bool bound) {
  std::vector<Curve> curves = {{table, "noise", "acceleration", CurveStyle::squares, "did not pop through"}};
  if (bound) curves.push_back({"bound", "noise", "printed", CurveStyle::line, "bound (4.25) as printed"});
  return map_panel(title, std::move(curves));
}

}  // namespace remote_touch
