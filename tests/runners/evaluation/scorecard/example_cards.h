// Scorecards of sweeps that are made by hand.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runners/evaluation/scorecard/evaluation.h"

namespace remote_touch::made_cards {

struct NamedValues {
  const char* name;
  std::vector<double> values;
  const char* units = "1";
};

// A finished sweep over these levels of noise, with the values of its measures.
inline SweepResult finished_sweep(const std::vector<double>& noise_m,
                                  const std::vector<NamedValues>& measures) {
  SweepResult result;
  result.axes = {{"noise_sigma_m", "m", "", noise_m}};
  result.replicates = static_cast<int>(measures.front().values.size() / noise_m.size());
  for (const NamedValues& each : measures) result.measures.push_back({each.name, each.units, "", {}});
  result.start(false);
  for (std::size_t i = 0; i < measures.size(); ++i) result.measures[i].values = measures[i].values;
  for (RunState& state : result.state) state = RunState::done;
  return result;
}

// 20 runs without noise, which are all one run, and 20 with noise, of which with_noise succeed. The measure
// "steps" is 1 without noise. Replicate i with noise has 1 + steps (1 + 0.1 (i mod 3)) + i, where the scatter
// i is the same for all methods.
inline SweepResult sweep_of(bool without_noise, int with_noise, double steps) {
  std::vector<double> held(40, without_noise ? 1.0 : 0.0), count(40, 1);
  for (int i = 0; i < 20; ++i) {
    held[static_cast<std::size_t>(20 + i)] = i < with_noise ? 1 : 0;
    count[static_cast<std::size_t>(20 + i)] = 1 + steps * (1 + 0.1 * (i % 3)) + i;
  }
  return finished_sweep({0, 0.005}, {{"held", held}, {"steps", count}});
}

inline constexpr const char* kOwnMethod = "tracked-sheet";

// Scorecard of the methods kOwnMethod, proxy and penalty; the sweeps of each scene are in this order.
inline Scorecard card_of(const std::vector<std::vector<SweepResult>>& scenes,
                         const std::vector<std::pair<std::string, Better>>& measures = {
                             {"steps", Better::smaller}}) {
  Scorecard card{{kOwnMethod, "proxy", "penalty"}, {"", "", ""}, {}};
  for (const auto& sweeps : scenes) {
    const std::string name = "scene " + std::to_string(card.scenes.size());
    card.scenes.push_back(score({name, "", "", {{"held", 1}}, measures, {{"steps", -1000}}}, sweeps, false));
  }
  correct(card);
  return card;
}

}  // namespace remote_touch::made_cards
