// Scorecards of sweeps that are made by hand.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runners/evaluation/scorecard/evaluation.h"

namespace remote_touch::made_cards {

// 20 runs without noise, which are all one run, and 20 with noise, of which with_noise succeed. The measure
// "steps" is 1 without noise. Replicate i with noise has 1 + steps (1 + 0.1 (i mod 3)) + i, where the scatter
// i is the same for all methods.
inline SweepResult sweep_of(bool without_noise, int with_noise, double steps) {
  SweepResult result;
  result.axes = {{"noise_sigma_m", "m", "", std::vector<double>{0, 0.005}}};
  result.replicates = 20;
  result.measures = {{"held", "1", "", {}}, {"steps", "1", "", {}}};
  result.start(false);
  std::vector<double> held(40, without_noise ? 1.0 : 0.0), count(40, 1);
  for (int i = 0; i < 20; ++i) {
    held[static_cast<std::size_t>(20 + i)] = i < with_noise ? 1 : 0;
    count[static_cast<std::size_t>(20 + i)] = 1 + steps * (1 + 0.1 * (i % 3)) + i;
  }
  result.measures[0].values = held, result.measures[1].values = count;
  for (RunState& state : result.state) state = RunState::done;
  return result;
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
