// All sweeps of a scorecard: those of its scenes, and those of the passivity audit.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runners/evaluation/scorecard/benchmark_run.h"

namespace remote_touch {

struct ScenePlan {
  BenchmarkScene scene;
  std::vector<BenchmarkSweep> sweeps;  // one for each method
};

struct BenchmarkPlan {
  Benchmark benchmark;
  std::vector<ScenePlan> scenes;
  // Force laws that the passivity audit compares, and their sweeps in each of its scenes; empty without them.
  std::vector<Method> laws;
  std::vector<ScenePlan> audit;
  // Scenes whose recording is not on this machine, and why.
  std::vector<std::pair<std::string, std::string>> skipped;

  std::vector<BenchmarkSweep> sweeps() const;  // each sweep once
};

// Resolves and checks every run. Throws InputError for what cannot be run.
BenchmarkPlan plan_of(const Benchmark& benchmark);

}  // namespace remote_touch
