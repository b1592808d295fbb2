// Summaries of the numbers of a scorecard: which methods stand out, how often, and at what cost.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/scorecard/card_summaries.h"
#include "runners/evaluation/scorecard/report.h"

namespace remote_touch {

// Returns a sentence: the best and the worst method by successes, or that none differs from another.
std::string verdict(const Scorecard& card, const SceneScore& scene);

// Medians over the scenes in which both the method and the reference were measured; NaN where there are none.
struct CostSummary {
  double tick_ratio, frame_ratio;  // fractions of the reference's time
  double tick_s, frame_s;
};
// The chapter 4 proxy, or the first method. pre: there is a method.
std::string cost_reference(const Scorecard& card);
std::vector<CostSummary> cost_summary(const Scorecard& card, const std::vector<Cost>& costs);

// The energy that a hand got from a force law at one noise level.
struct EnergySummary {
  Estimate per_cycle_J;
  double per_update_J;  // mean from one frame update to the next
};
// Returns the energies by law and level in a scene of the audit. None if the scene does not measure energy.
std::optional<std::vector<std::vector<EnergySummary>>> energies(const SceneScore& scene);

}  // namespace remote_touch
