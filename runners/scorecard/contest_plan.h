// All the sweeps of a scorecard: those of its scenes, and of the passivity audit.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runners/scorecard/contest_run.h"

namespace remote_touch {

struct ScenePlan {
  ContestScene scene;
  std::vector<ContestSweep> sweeps;  // of each contender
};

struct ContestPlan {
  Contest contest;
  std::vector<ScenePlan> scenes;
  // Force laws that the audit compares, and their sweeps; empty without its scene.
  std::vector<Contender> laws;
  std::vector<ContestSweep> audit;
  // Scenes whose recording is not on this machine, and why.
  std::vector<std::pair<std::string, std::string>> skipped;

  std::vector<ContestSweep> sweeps() const;  // each once
};

// Resolves and checks every run. Throws InputError for what cannot be run.
ContestPlan plan_of(const Contest& contest);

}  // namespace remote_touch
