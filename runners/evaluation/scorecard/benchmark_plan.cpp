#include "runners/evaluation/scorecard/benchmark_plan.h"

#include <algorithm>

#include "runners/evaluation/scorecard/passivity.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

std::vector<BenchmarkSweep> BenchmarkPlan::sweeps() const {
  std::vector<BenchmarkSweep> list;
  for (const ScenePlan& one : scenes) list.insert(list.end(), one.sweeps.begin(), one.sweeps.end());
  // A method's own force law is also in the audit, with the same file, so it is listed once.
  for (const ScenePlan& scene : audit)
    for (const BenchmarkSweep& one : scene.sweeps)
      if (std::none_of(list.begin(), list.end(),
                       [&](const BenchmarkSweep& other) { return other.name == one.name; }))
        list.push_back(one);
  return list;
}

BenchmarkPlan plan_of(const Benchmark& benchmark) {
  BenchmarkPlan plan;
  plan.benchmark = benchmark;
  for (const BenchmarkScene& scene : plan.benchmark.scenes) {
    try {
      plan.scenes.push_back({scene, sweeps_of(plan.benchmark, scene)});
    } catch (const MissingRecording& missing) {
      plan.skipped.emplace_back(scene.name, missing.what());
      continue;
    }
    if (!is_passivity_scene(scene.name)) continue;
    if (plan.laws.empty())
      for (const Method& method : plan.benchmark.methods)
        for (Method& law : force_laws_of(method)) plan.laws.push_back(std::move(law));
    Benchmark audit = plan.benchmark;
    audit.methods = plan.laws;
    plan.audit.push_back({scene, sweeps_of(audit, scene)});
  }
  return plan;
}

}  // namespace remote_touch
