#include "runners/evaluation/figures/pop_through_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "analysis/statistics/extremes.h"
#include "analysis/statistics/proportion.h"
#include "runners/experiment/settings/second_implementation.h"

namespace remote_touch {

Table cell_table(const std::string& name, const std::string& title, std::vector<double> noise,
                 std::vector<double> acceleration) {
  Table table{name, title};
  table.add("noise", "r_c", "standard deviation of the noise", std::move(noise));
  table.add("acceleration", "r_c/s^2", "acceleration of the lift", std::move(acceleration));
  return table;
}

Table noise_table(const std::string& name, const std::string& title) {
  std::vector<double> noise;
  for (int i = 0; i <= 150; ++i) noise.push_back(0.02 * i);
  Table table{name, title};
  table.add("noise", "r_c", "standard deviation of the noise", noise);
  return table;
}

Table map_table(const std::string& name, const SweepResult& result, const std::string& measure) {
  const auto& sigma = std::get<std::vector<double>>(result.axes.at(0).values);
  const auto& acceleration = std::get<std::vector<double>>(result.axes.at(1).values);
  const std::vector<double>& popped = result.measure(measure);
  std::vector<double> x, y, survived, low, high, runs;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    const Tally t = tally(result, popped, cell);
    const auto indices = result.axis_indices(cell);
    const auto interval = wilson_interval(t.runs - t.events, t.runs);
    x.push_back(sigma[indices[0]] / kContactRadius_m);
    y.push_back(acceleration[indices[1]] / kContactRadius_m);
    survived.push_back(1 - static_cast<double>(t.events) / t.runs);
    low.push_back(interval.first), high.push_back(interval.second);
    runs.push_back(t.runs);
  }
  Table table = cell_table(name, "lifts that did not pop through", x, y);
  table.add("survived", "1", "share of lifts that did not pop through", survived);
  table.add("survived_low", "1", "lower end of its 95 % Wilson interval", low);
  table.add("survived_high", "1", "upper end of its 95 % Wilson interval", high);
  table.add("runs", "1", "number of lifts", runs);
  return table;
}

Table region_table(const std::string& name, const Table& map) {
  constexpr double kNoise[] = {0, 0.5, 1, 1.5, 2, 3.001}, kAcceleration[] = {0, 300, 600, 898, 1150, 1e9};
  const auto &x = numbers(map, "noise"), &y = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  // A node on an edge belongs to the region above it, whatever its last bit.
  constexpr double kEdge = 1e-9;
  std::vector<double> noise, acceleration, success;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      double sum = 0, count = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const bool in_column = x[i] + kEdge >= kNoise[column] && x[i] + kEdge < kNoise[column + 1];
        const bool in_row = y[i] + kEdge >= kAcceleration[row] && y[i] + kEdge < kAcceleration[row + 1];
        if (in_column && in_row) sum += survived[i], ++count;
      }
      noise.push_back(kNoise[column]), acceleration.push_back(kAcceleration[row]);
      success.push_back(sum / count);
    }
  Table table{name, "success by region"};
  table.add("noise_from", "r_c", "lower edge of the region", noise);
  table.add("acceleration_from", "r_c/s^2", "lower edge of the region", acceleration);
  table.add("survived", "1", "share of lifts that did not pop through", success);
  return table;
}

double SharedLifts::standard_error(double our_lifts_a_node) const {
  const double lifts = nodes * lifts_a_node, at_least = (variance * lifts + 1) / (lifts + 1);
  return std::sqrt(at_least / nodes * (1 / lifts_a_node + 1 / our_lifts_a_node));
}

Claim claim_agrees(const std::string& figure, const std::string& claim, const std::string& paper,
                   double measured, const SharedLifts& other, double our_lifts_a_node) {
  const double slack = kByChance * other.standard_error(our_lifts_a_node);
  return claim_between(figure, claim, paper, measured, std::max(0.0, other.survived - slack),
                       std::min(1.0, other.survived + slack), "fraction");
}

double max_apart(const Table& table) {
  const std::vector<double>& values = numbers(table, "apart");
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
  std::vector<double> filled_x, filled_y;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (survived[i] > 0.5) filled_x.push_back(x[i]), filled_y.push_back(y[i]);
  return cell_table(name, "cells whose lift did not pop through", filled_x, filled_y);
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
  Panel panel{title, "noise (r_c)", "acceleration (r_c/s^2)", false, std::move(curves)};
  panel.x_range = {-0.02, 3.02};
  panel.y_range = {-10, 1410};
  return panel;
}

}  // namespace remote_touch
