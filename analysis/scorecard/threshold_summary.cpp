#include "analysis/scorecard/threshold_summary.h"

#include "analysis/scorecard/card_numbers.h"

namespace remote_touch {

namespace {

const SceneThreshold* find_threshold(const SceneScore& scene, const std::string& measure) {
  for (const SceneThreshold& one : scene.thresholds)
    if (one.measure == measure) return &one;
  return nullptr;
}

void add_scene(const SceneThreshold& scene, ThresholdSummary& summary) {
  for (std::size_t c = 0; c < summary.methods.size(); ++c) {
    ThresholdCounts& counts = summary.methods[c];
    const Successes& below = scene.below[c];
    counts.scenes += below.noisy.runs > 0 ? 1 : 0;
    counts.below += below.noisy.events, counts.runs += below.noisy.runs;
    if (!below.noise_free) continue;
    counts.noise_free_below += below.noise_free->events, counts.noise_free_runs += below.noise_free->runs;
  }
}

}  // namespace

std::vector<ThresholdSummary> threshold_summary(const Scorecard& card) {
  std::vector<ThresholdSummary> list;
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    ThresholdSummary summary{threshold, std::vector<ThresholdCounts>(card.methods.size())};
    bool is_reported = false;
    for (const SceneScore& scene : card.scenes) {
      const SceneThreshold* found = find_threshold(scene, threshold.measure);
      if (!found) continue;
      is_reported = true;
      add_scene(*found, summary);
    }
    if (is_reported) list.push_back(std::move(summary));
  }
  return list;
}

Table thresholds_table(const Scorecard& card) {
  struct Row {
    PerceptionThreshold threshold;
    std::string method;
    ThresholdCounts counts;
  };
  std::vector<Row> rows;
  for (const ThresholdSummary& summary : threshold_summary(card))
    for (std::size_t c = 0; c < card.methods.size(); ++c)
      rows.push_back({summary.threshold, card.methods[c], summary.methods[c]});
  Table table{"thresholds", "runs in which a measure is below a published threshold of perception"};
  const auto text = [&](const char* name, const char* meaning, const char* PerceptionThreshold::*member) {
    add_column(table, rows, name, meaning,
               [member](const Row& row) { return std::string(row.threshold.*member); });
  };
  const auto count = [&](const char* name, const char* meaning, int ThresholdCounts::*member) {
    add_column(table, rows, name, meaning,
               [member](const Row& row) { return static_cast<std::int32_t>(row.counts.*member); });
  };
  text("measure", "measure", &PerceptionThreshold::measure);
  add_column(table, rows, "method", "method", &Row::method);
  text("units", "unit of the measure and of its threshold", &PerceptionThreshold::unit);
  add_column(table, rows, "threshold", "the threshold, in the measure's unit",
             [](const Row& row) { return row.threshold.value; });
  text("meaning", "what the source of the threshold measured", &PerceptionThreshold::meaning);
  text("source", "the source of the threshold", &PerceptionThreshold::source);
  count("scenes", "scenes with at least one successful run with noise that has the measure",
        &ThresholdCounts::scenes);
  count("below", "successful runs with noise whose measure is below the threshold", &ThresholdCounts::below);
  count("runs", "successful runs with noise that have the measure", &ThresholdCounts::runs);
  count("noise_free_below", "like below, without noise", &ThresholdCounts::noise_free_below);
  count("noise_free_runs", "like runs, without noise", &ThresholdCounts::noise_free_runs);
  return table;
}

}  // namespace remote_touch
