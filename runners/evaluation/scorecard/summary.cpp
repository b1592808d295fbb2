#include "runners/evaluation/scorecard/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/evaluation/scorecard/passivity.h"

namespace remote_touch {

namespace {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Adds the ratio and the method's own cost if both costs were measured. The lists are sorted later, so they
// must not contain NaN.
void add_cost(double own_s, double other_s, std::vector<double>& ratio, std::vector<double>& all_s) {
  if (!(std::isfinite(own_s) && std::isfinite(other_s) && own_s > 0 && other_s > 0)) return;
  ratio.push_back(own_s / other_s), all_s.push_back(own_s);
}

const JudgedMeasure* find_measure(const SceneScore& scene, const std::string& name) {
  for (const JudgedMeasure& measure : scene.measures)
    if (measure.name == name) return &measure;
  return nullptr;
}

}  // namespace

std::string verdict(const Scorecard& card, const SceneScore& scene) {
  const Ranking& ranking = scene.ranking;
  if (ranking.ranked < 2) return "";
  std::string text;
  if (ranking.has_best) {
    text = "Best: " + card.methods[ranking.order.front()] + ".";
  } else if (ranking.top_group.size() == ranking.ranked) {
    text = "No difference between any.";
  } else {
    text = "No difference at the top:";
    for (const std::size_t c : ranking.top_group)
      text += (c == ranking.top_group.front() ? " " : ", ") + card.methods[c];
    text += ".";
  }
  if (ranking.has_worst) text += " Worst: " + card.methods[ranking.order[ranking.ranked - 1]] + ".";
  return text;
}

std::string cost_reference(const Scorecard& card) {
  const auto proxy = std::find(card.methods.begin(), card.methods.end(), "proxy");
  return proxy != card.methods.end() ? *proxy : card.methods.front();
}

std::vector<CostSummary> cost_summary(const Scorecard& card, const std::vector<Cost>& costs) {
  std::vector<CostSummary> methods;
  const std::string reference = cost_reference(card);
  for (const std::string& method : card.methods) {
    std::vector<double> tick_ratio, frame_ratio, tick_s, frame_s;
    for (const SceneScore& scene : card.scenes) {
      const Cost* own = find_cost(costs, scene.name, method);
      const Cost* other = find_cost(costs, scene.name, reference);
      if (!own || !other) continue;
      add_cost(own->tick_s, other->tick_s, tick_ratio, tick_s);
      add_cost(own->frame_s, other->frame_s, frame_ratio, frame_s);
    }
    methods.push_back({median(tick_ratio), median(frame_ratio), median(tick_s), median(frame_s)});
  }
  return methods;
}

std::optional<std::vector<std::vector<EnergySummary>>> energies(const SceneScore& scene) {
  const JudgedMeasure* run = find_measure(scene, "energy_injected");
  const JudgedMeasure* update = find_measure(scene, "mean_energy_per_update");
  if (!run || !update) return {};
  std::vector<std::vector<EnergySummary>> laws(run->at_level.size());
  for (std::size_t c = 0; c < laws.size(); ++c)
    for (std::size_t i = 0; i < scene.noise_m.size(); ++i) {
      Estimate cycle = run->at_level[c][i];
      for (double* energy : {&cycle.value, &cycle.low, &cycle.high}) *energy /= kPassivityCycles;
      laws[c].push_back({cycle, update->at_level[c][i].value});
    }
  return laws;
}

}  // namespace remote_touch
