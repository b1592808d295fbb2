#include "runners/evaluation/figures/pop_through_map.h"

#include <algorithm>
#include <cmath>

#include "analysis/trace/measures.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

std::string seed_setting(int seed) {
  return "seed=" + std::to_string(seed);
}

namespace {

// Returns the position of the grid under a lift along x and z, in units of the grid's spacing.
std::pair<double, double> phase(std::size_t n, std::size_t lift) {
  const auto part = [&](std::size_t place) { return static_cast<double>(place) / static_cast<double>(n); };
  return {part(lift / n), part(lift % n)};
}

// Returns 1 for each position at which the lift pops through, and 0 for the others. acceleration: of each.
Numbers popped_over_phases(FigureContext& context, std::size_t n, const Numbers& acceleration,
                           const std::vector<std::string>& overrides) {
  std::vector<Experiment> lifts;
  for (std::size_t i = 0; i < n * n; ++i) {
    const auto [x, z] = phase(n, i);
    std::vector<std::string> settings = overrides;
    settings.insert(
        settings.end(),
        {"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=" + std::to_string(acceleration.at(i)),
         "scenario.phase_x=" + std::to_string(x), "scenario.phase_z=" + std::to_string(z)});
    lifts.push_back(Experiment::load("fig4.12", settings));
  }
  Numbers popped = context.measure(lifts, popped_through);
  if (std::ranges::any_of(popped, [](double lift) { return std::isnan(lift); }))
    throw InputError("popped_through",
                     "is unknown for a lift of a figure: expected a known surface below it");
  return popped;
}

}  // namespace

double survived_over_phases(FigureContext& context, std::size_t n, double acceleration_m_per_s2,
                            const std::vector<std::string>& overrides) {
  return 1 - mean(popped_over_phases(context, n, Numbers(n * n, acceleration_m_per_s2), overrides));
}

Table critical_over_phases(FigureContext& context) {
  constexpr std::size_t kPhases = 8 * 8;
  Numbers low(kPhases, kSurvives), high(kPhases, kPops), middle(kPhases);
  for (int halving = 0; halving < 10; ++halving) {
    for (std::size_t i = 0; i < kPhases; ++i) middle[i] = 0.5 * (low[i] + high[i]);
    const Numbers popped = popped_over_phases(context, 8, middle, {});
    for (std::size_t i = 0; i < kPhases; ++i) (popped[i] > 0.5 ? high : low)[i] = middle[i];
  }
  return {"phases",
          "critical acceleration without noise, by position of the grid",
          {{"phase_x", "1", "shift of the grid in units of its spacing",
            each_of(kPhases, [](std::size_t i) { return phase(8, i).first; })},
           {"phase_z", "1", "shift of the grid in units of its spacing",
            each_of(kPhases, [](std::size_t i) { return phase(8, i).second; })},
           {"survives", "m/s^2", "largest acceleration tried without pop-through", low},
           {"pops", "m/s^2", "smallest acceleration tried with pop-through", high}}};
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
      const auto is_inside = [&](std::size_t i) {
        return x[i] + kEdge >= kNoise[column] && x[i] + kEdge < kNoise[column + 1] &&
               y[i] + kEdge >= kAcceleration[row] && y[i] + kEdge < kAcceleration[row + 1];
      };
      rows.push_back({kNoise[column], kAcceleration[row], share_of_known(where(survived, is_inside))});
    }
  return table_of(name, "success by region",
                  {{"noise_from", "r_c", "lower edge of the region"},
                   {"acceleration_from", "r_c/s^2", "lower edge of the region"},
                   {"survived", "1", "share of lifts that did not pop through"}},
                  rows);
}

double max_apart(const Table& table) {
  return max_of(magnitudes(numbers(table, "difference_in_standard_errors")));
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
  table.add(column, "r_c/s^2", meaning, each(numbers(table, "noise"), [&](double noise) {
              return bound_m_per_s2(noise * kContactRadius_m) / kContactRadius_m;
            }));
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
