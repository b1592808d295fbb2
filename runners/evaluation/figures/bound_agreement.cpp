#include "runners/evaluation/figures/bound_agreement.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "analysis/measures/no_value.h"
#include "analysis/statistics/interval_estimates.h"
#include "runners/evaluation/figures/pop_through_map.h"

namespace remote_touch {

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
