#include "runners/evaluation/figures/parts/pop_through_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

std::string seed_setting(int seed) {
  return "seed=" + std::to_string(seed);
}

std::string noise_setting(double noise) {
  return "scenario.noise_sigma_m=" + std::to_string(noise * kContactRadius_m);
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

Table map_table(const std::string& name, const SweepResult& result, const std::string& measure) {
  const std::vector<double>& popped = result.measure(measure);
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

namespace {

// Updates in which the velocity estimate has reached its level.
constexpr SettledFrom kSettled{kRiseFrames + 5};

// Returns the position of the grid below the proxy, in units of its spacing. step: 0 to 7.
double phase_of(std::size_t step) {
  return 0.125 * static_cast<double>(step);
}

LiftUpdates updates_of(const Trace& trace) {
  return lift_updates(trace, Vec3(0, 1, 0), kLift.r1_m, kLift.frame_rate_hz);
}

std::vector<double> popped_over_phases(FigureContext& context, const std::vector<double>& acceleration) {
  std::vector<Experiment> lifts;
  for (std::size_t i = 0; i < acceleration.size(); ++i)
    lifts.push_back(Experiment::load(
        "fig4.12",
        {"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=" + std::to_string(acceleration[i]),
         "scenario.phase_x=" + std::to_string(phase_of(i / 8)),
         "scenario.phase_z=" + std::to_string(phase_of(i % 8))}));
  return known_pop_throughs(context, lifts);
}

}  // namespace

Phases critical_over_phases(FigureContext& context) {
  constexpr std::size_t kCount = 64;
  Phases phases;
  std::vector<double> low(kCount, Phases::kSurvives), high(kCount, Phases::kPops), middle(kCount), x, z;
  phases.survived_low = 1 - mean(popped_over_phases(context, low));
  phases.survived_high = 1 - mean(popped_over_phases(context, high));
  for (int halving = 0; halving < 10; ++halving) {
    for (std::size_t i = 0; i < kCount; ++i) middle[i] = 0.5 * (low[i] + high[i]);
    const std::vector<double> popped = popped_over_phases(context, middle);
    for (std::size_t i = 0; i < kCount; ++i) (popped[i] > 0.5 ? high : low)[i] = middle[i];
  }
  for (std::size_t i = 0; i < kCount; ++i) x.push_back(phase_of(i / 8)), z.push_back(phase_of(i % 8));
  phases.table.add("phase_x", "1", "shift of the grid in units of its spacing", x);
  phases.table.add("phase_z", "1", "shift of the grid in units of its spacing", z);
  phases.table.add("survives", "m/s^2", "largest acceleration tried without pop-through", low);
  phases.table.add("pops", "m/s^2", "smallest acceleration tried with pop-through", high);
  return phases;
}

NoiseEffect MeasuredNoise::at(double noise_m) const {
  const auto above = std::upper_bound(sigma_m.begin() + 1, sigma_m.end() - 1, noise_m);
  const auto i = static_cast<std::size_t>(above - sigma_m.begin());
  const double t = (noise_m - sigma_m[i - 1]) / (sigma_m[i] - sigma_m[i - 1]);
  const auto between = [&](double NoiseEffect::*part) {
    return effect[i - 1].*part + t * (effect[i].*part - effect[i - 1].*part);
  };
  return {between(&NoiseEffect::thickness_m),           between(&NoiseEffect::thickness_sd_m),
          between(&NoiseEffect::normal_error),          between(&NoiseEffect::normal_error_sd),
          between(&NoiseEffect::velocity_bias_m_per_s), between(&NoiseEffect::velocity_sd_m_per_s),
          between(&NoiseEffect::margin_sd_m),           between(&NoiseEffect::gain)};
}

MeasuredNoise measured_noise(FigureContext& context) {
  const Sweep sweep = Sweep::load("steady-lifts");
  const SweepResult plan = sweep.plan();
  const std::vector<LiftUpdates> lifts = context.measure(sweep, updates_of);
  MeasuredNoise noise;
  noise.sigma_m = axis_values(plan, 0);
  std::vector<double> x, thickness, normal_error;
  for (std::size_t cell = 0; cell < noise.sigma_m.size(); ++cell) {
    const auto first = lifts.begin() + static_cast<std::ptrdiff_t>(plan.run(cell, 0));
    const std::vector<LiftUpdates> of_cell(first, first + plan.replicates);
    noise.effect.push_back(noise_effect(of_cell, kSettled, kLift.r1_m, kLift.frame_rate_hz));
    if (noise.sigma_m[cell] > kFitted_m * (1 + 1e-9)) continue;
    for (const LiftUpdates& lift : of_cell) {
      const LiftMeans means = lift_means(lift, kSettled);
      if (std::isnan(means.thickness_m)) continue;
      x.push_back(noise.sigma_m[cell]);
      thickness.push_back(means.thickness_m), normal_error.push_back(means.normal_error);
    }
  }
  noise.thickness = fit_polynomial(x, thickness, printed_thickness().powers);
  noise.normal_error = fit_polynomial(x, normal_error, printed_normal_error().powers);
  return noise;
}

Table effect_table(const MeasuredNoise& noise) {
  Table table{"noise_effect", "what noise does, measured over lifts without acceleration"};
  std::vector<double> strengths;
  for (const double sigma : noise.sigma_m) strengths.push_back(sigma / kContactRadius_m);
  table.add("noise", "r_c", "standard deviation of the noise", strengths);
  add_columns<NoiseEffect>(
      table, noise.effect,
      {{"thickness", "m", "h, mean", &NoiseEffect::thickness_m},
       {"thickness_sd", "m", "h, standard deviation", &NoiseEffect::thickness_sd_m},
       {"normal_error", "1", "e_n, mean", &NoiseEffect::normal_error},
       {"normal_error_sd", "1", "e_n, standard deviation", &NoiseEffect::normal_error_sd},
       {"velocity_bias", "m/s", "velocity estimate minus velocity, mean",
        &NoiseEffect::velocity_bias_m_per_s},
       {"velocity_sd", "m/s", "velocity estimate, standard deviation", &NoiseEffect::velocity_sd_m_per_s},
       {"margin_sd", "m", "margin of (4.17), standard deviation", &NoiseEffect::margin_sd_m},
       {"gain", "1", "share of a velocity error that one update corrects", &NoiseEffect::gain}});
  return table;
}

LiftMap lift_map(FigureContext& context, int seed) {
  const Sweep sweep = context.map("fig4.13", {seed_setting(seed)});
  const SweepResult plan = sweep.plan();
  LiftMap result;
  result.updates = context.measure(sweep, updates_of);
  TableRows rows;
  for (std::size_t cell = 0; cell < plan.cell_count(); ++cell)
    rows.push_back({axis_value(plan, 0, cell) / kContactRadius_m,
                    axis_value(plan, 1, cell) / kContactRadius_m,
                    result.updates[cell].back().above_after ? 1.0 : 0.0});
  result.map = table_of(
      "map", "lifts that did not pop through",
      {kNoiseColumn, kAccelerationColumn, {"survived", "1", "1 when the lift did not pop through"}}, rows);
  return result;
}

namespace {

void count_updates(const LiftUpdates& lift, Criterion& count) {
  for (const LiftUpdate& update : lift) {
    if (update.frame <= kRiseFrames) continue;
    if (!update.above_before) return;
    const bool holds = update.margin_m(kLift.r1_m, kLift.frame_rate_hz) > 0;
    if (holds)
      ++(update.above_after ? count.holds_stays : count.holds_pops);
    else
      ++(update.above_after ? count.fails_stays : count.fails_pops);
  }
}

}  // namespace

Criterion criterion_of(const LiftMap& lifts, double low, double high) {
  const std::vector<double>& noise = numbers(lifts.map, "noise");
  Criterion count;
  for (std::size_t i = 0; i < noise.size(); ++i)
    if (noise[i] >= low && noise[i] < high) count_updates(lifts.updates[i], count);
  return count;
}

Table criterion_table(const LiftMap& lifts) {
  // The first range is noise-free, the others are half an r_c wide. No node of the map lies on an edge.
  constexpr double kEdges[] = {0, 0.01, 0.51, 1.01, 1.51, 2.01, 2.51, 3.01};
  TableRows rows;
  for (std::size_t i = 0; i + 1 < std::size(kEdges); ++i) {
    const Criterion c = criterion_of(lifts, kEdges[i], kEdges[i + 1]);
    rows.push_back({kEdges[i], c.holds_stays, c.holds_pops, c.fails_stays, c.fails_pops, c.agreement()});
  }
  return table_of("criterion", "(4.17) at each of the ten updates of every lift, and what happened",
                  {{"noise_from", "r_c", "lower edge of the range of noise"},
                   {"holds_and_stays", "1", "(4.17) holds and the proxy stays above"},
                   {"holds_but_pops", "1", "(4.17) holds but the proxy pops through"},
                   {"fails_but_stays", "1", "(4.17) does not hold but the proxy stays above"},
                   {"fails_and_pops", "1", "(4.17) does not hold and the proxy pops through"},
                   {"agreement", "1", "share in which they agree"}},
                  rows);
}

std::vector<AccelerationBound> bounds(const MeasuredNoise& noise) {
  const auto printed = [](double noise_m, double less) {
    return bound_acceleration(kLift, printed_thickness().at(noise_m) - less,
                              printed_normal_error().at(noise_m));
  };
  const auto refitted = [&noise](double noise_m, double less) {
    return bound_acceleration(kLift, noise.thickness.at(noise_m) - less, noise.normal_error.at(noise_m));
  };
  // Error of the predicted surface height over one frame if the velocity estimate is off by one standard
  // deviation.
  const auto deviation = [&noise](double noise_m) {
    return noise.at(noise_m).velocity_sd_m_per_s / kLift.frame_rate_hz;
  };
  return {{"printed", "(4.25) as printed", [=](double s) { return printed(s, 0); }},
          {"printed_less", "(4.25) as printed, less one deviation of v_hat",
           [=](double s) { return printed(s, deviation(s)); }},
          {"refitted", "(4.25) refitted", [=](double s) { return refitted(s, 0); }, kFitted_m},
          {"refitted_less", "(4.25) refitted, less one deviation of v_hat",
           [=](double s) { return refitted(s, deviation(s)); }, kFitted_m},
          {"scatter", "with scatter, ten updates",
           [&noise](double s) { return scatter_bound(kLift, noise.at(s)); }}};
}

Agreement agreement_of(const AccelerationBound& bound, const Table& map, double max_noise) {
  const auto &noise = numbers(map, "noise"), &acceleration = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  std::map<double, double> limit;
  for (const double x : noise) limit.try_emplace(x, bound.at(x * kContactRadius_m) / kContactRadius_m);
  int cells = 0, safe = 0, safe_popped = 0, unsafe_survived = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (noise[i] > max_noise || std::isnan(limit[noise[i]])) continue;
    const bool is_safe = acceleration[i] < limit[noise[i]];
    const bool stays = survived[i] > 0.5;
    ++cells;
    safe += is_safe ? 1 : 0;
    safe_popped += is_safe && !stays ? 1 : 0;
    unsafe_survived += !is_safe && stays ? 1 : 0;
  }
  return {cells, cells - safe_popped - unsafe_survived, static_cast<double>(safe_popped) / safe,
          static_cast<double>(unsafe_survived) / (cells - safe)};
}

Table agreement_table(const std::vector<AccelerationBound>& bounds, const Table& map) {
  constexpr double kFittedNoise = kFitted_m / kContactRadius_m + 0.01;
  Column names{"bound", "1", "which bound", {}, 1, {}};
  std::vector<std::int32_t> number;
  TableRows rows;
  for (const AccelerationBound& bound : bounds) {
    number.push_back(static_cast<std::int32_t>(number.size()));
    names.value_names.push_back(bound.name);
    const Agreement all = agreement_of(bound, map), inside = agreement_of(bound, map, kFittedNoise);
    const auto [low, high] = exact_interval(all.agree, all.cells);
    rows.push_back({all.fraction(), low, high, all.safe_popped, all.unsafe_survived, inside.fraction(),
                    inside.safe_popped});
  }
  names.values = number;
  Table table =
      table_of("agreement", "bounds against the outcome of 5396 lifts",
               {{"cells", "1", "share of cells in which bound and outcome agree"},
                {"cells_low", "1", "lower end of its 95 % interval"},
                {"cells_high", "1", "upper end of its 95 % interval"},
                {"safe_popped", "1", "share of the bound's safe cells that popped through"},
                {"unsafe_survived", "1", "share of the bound's unsafe cells that survived"},
                {"fitted_cells", "1", "share that agrees up to 2 r_c of noise, where the fits are meant"},
                {"fitted_safe_popped", "1", "share of the safe cells there that popped through"}},
               rows);
  table.columns.insert(table.columns.begin(), names);
  return table;
}

Table calibration_table(const MeasuredNoise& noise, const Table& map) {
  constexpr int kRanges = static_cast<int>(std::size(kNoiseRanges)), kBins = 10;
  const auto &x = numbers(map, "noise"), &acceleration = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  std::vector<double> predicted(kRanges * kBins), observed(kRanges * kBins), cells(kRanges * kBins);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p =
        survival_probability(kLift, noise.at(x[i] * kContactRadius_m), acceleration[i] * kContactRadius_m);
    if (std::isnan(p)) continue;
    const int range = std::min(kRanges - 1, static_cast<int>(x[i])),
              bin = std::min(kBins - 1, static_cast<int>(kBins * p));
    const auto slot = static_cast<std::size_t>(range * kBins + bin);
    predicted[slot] += p, observed[slot] += survived[i], ++cells[slot];
  }
  Table table{"calibration", "survival as the bound with scatter predicts it, and as observed"};
  for (int range = 0; range < kRanges; ++range) {
    std::vector<double> mean_predicted, mean_observed, low, high, count;
    for (int bin = 0; bin < kBins; ++bin) {
      const auto slot = static_cast<std::size_t>(range * kBins + bin);
      mean_predicted.push_back(predicted[slot] / cells[slot]);  // NaN for a bin without cells
      mean_observed.push_back(observed[slot] / cells[slot]);
      const bool is_empty = cells[slot] == 0;
      const auto ends = exact_interval(observed[slot], cells[slot]);
      low.push_back(is_empty ? kNoValue : ends.first), high.push_back(is_empty ? kNoValue : ends.second);
      count.push_back(cells[slot]);
    }
    const std::string name = kNoiseRanges[range].first;
    table.add("predicted_" + name, "1", "mean prediction of the cells", mean_predicted);
    table.add("observed_" + name, "1", "share of them that survived", mean_observed);
    table.add("observed_low_" + name, "1", "lower end of its 95 % interval", low);
    table.add("observed_high_" + name, "1", "upper end of its 95 % interval", high);
    table.add("cells_" + name, "1", "cells", count);
  }
  return table;
}

}  // namespace remote_touch
