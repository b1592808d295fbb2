// The results of a scorecard's runs: its numbers, failures, costs and the audit of passivity.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/scorecard/scorecard.h"
#include "runners/evaluation/scorecard/costs.h"
#include "runners/evaluation/scorecard/failure_traces.h"

namespace remote_touch {

struct ScorecardReport {
  Scorecard card;
  int replicates = 0;
  std::string origin;  // program and version
  // Scenes that could not be run here, and why.
  std::vector<std::pair<std::string, std::string>> skipped;
  std::vector<std::vector<std::optional<FailureTrace>>> failures;  // one for each scene and method
  std::vector<Cost> costs;
  // The passivity scenes with every force law, if they were run; its methods are the laws.
  std::optional<Scorecard> audit;
  std::string cpu = {};  // processor on which the costs were measured
};

}  // namespace remote_touch
