#include "runners/evaluation/scorecard/evaluation.h"

#include <omp.h>

#include "core/parameters/input_error.h"
#include "runners/evaluation/scorecard/passivity.h"
#include "runners/experiment/catalog/random_streams.h"
#include "runners/experiment/provenance/provenance.h"

namespace remote_touch {

namespace {

std::vector<StoredSweep> read_all(const std::vector<BenchmarkSweep>& sweeps) {
  std::vector<StoredSweep> stored;
  for (const BenchmarkSweep& sweep : sweeps) stored.push_back(read_sweep(sweep.file));
  return stored;
}

SceneScore score_of(const BenchmarkScene& scene, const std::vector<BenchmarkSweep>& sweeps,
                    const std::vector<StoredSweep>& stored) {
  SceneRules rules{scene.name, scene.title, scene.meaning, scene.success, {}, scene.old_success};
  for (const BenchmarkScene::Judged& judged : scene.measures)
    rules.measures.emplace_back(judged.measure, judged.better);
  for (const BenchmarkSweep& one : sweeps)
    rules.by_replicate.push_back(random_streams(one.sweep.experiment(0, 0)).of_replicate);
  std::vector<SweepResult> results;
  for (const StoredSweep& one : stored) results.push_back(one.result);
  return score(rules, results, scene.noise.empty());
}

// Returns the true surface of the sweep's scenario in words, see Scenario::truth_text(). Empty if the
// scenario cannot be built: the sweep's file contains the error.
std::string truth_of(const Sweep& sweep, const Kernels& kernels) {
  if (sweep.inputs().empty()) return {};
  try {
    return sweep.experiment(0, 0).build_scenario(kernels)->truth_text();
  } catch (const InputError&) {
    return {};
  }
}

// Returns the scene with measures that are only reported. A judged measure counts successful runs only, but
// the audit needs all runs, above all those that are not passive.
BenchmarkScene reported(BenchmarkScene scene) {
  for (BenchmarkScene::Judged& judged : scene.measures) judged.better = Better::neither;
  return scene;
}

Scorecard empty_card(const std::vector<Method>& methods) {
  Scorecard card;
  for (const Method& method : methods)
    card.methods.push_back(method.name), card.method_titles.push_back(method.title);
  return card;
}

// Computes on one thread while it lives.
class OneThread {
 public:
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(threads_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  const int threads_ = omp_get_max_threads();
};

// Measures the costs that the file does not contain yet, and returns all. Writes the file after each scene.
std::vector<Cost> costs_of(const BenchmarkPlan& plan, const Kernels& kernels, const std::atomic<bool>* stop,
                           const std::filesystem::path& file) {
  const TextAttributes origin = cost_origin(kernels);
  std::vector<Cost> costs = read_costs(file, origin);
  const OneThread one_thread;
  for (const ScenePlan& one : plan.scenes) {
    const std::size_t before = costs.size();
    for (std::size_t c = 0; c < one.sweeps.size(); ++c) {
      const std::string& method = plan.benchmark.methods[c].name;
      if (find_cost(costs, one.scene.name, method)) continue;
      costs.push_back(measured_cost(one.sweeps[c], one.scene.name, method, kernels, stop));
    }
    if (costs.size() > before) write_costs(file, costs, origin);
  }
  return costs;
}

}  // namespace

Scorecard scores_of(const BenchmarkPlan& plan) {
  Scorecard card = empty_card(plan.benchmark.methods);
  for (const ScenePlan& one : plan.scenes)
    card.scenes.push_back(score_of(one.scene, one.sweeps, read_all(one.sweeps)));
  correct(card);
  return card;
}

ScorecardReport evaluate(const BenchmarkPlan& plan, const Kernels& kernels, const std::atomic<bool>* stop,
                         const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::filesystem::path& folder = plan.benchmark.folder;
  ScorecardReport report{
      empty_card(plan.benchmark.methods), plan.benchmark.replicates, {}, plan.skipped, {}, {}, {}};
  for (const ScenePlan& one : plan.scenes) {
    progress(report.card.scenes.size(), plan.scenes.size());
    const std::vector<StoredSweep> stored = read_all(one.sweeps);
    report.card.scenes.push_back(score_of(one.scene, one.sweeps, stored));
    report.card.scenes.back().truth = truth_of(one.sweeps.front().sweep, kernels);
    report.failures.emplace_back();
    for (std::size_t c = 0; c < stored.size(); ++c)
      report.failures.back().push_back(
          trace_failure(one.sweeps[c], stored[c], one.scene.success, folder, kernels, stop));
  }
  if (!plan.audit.empty()) report.audit = empty_card(plan.laws);
  for (const ScenePlan& one : plan.audit)
    report.audit->scenes.push_back(score_of(reported(one.scene), one.sweeps, read_all(one.sweeps)));
  correct(report.card);
  report.costs = costs_of(plan, kernels, stop, folder / "costs.json");
  report.cpu = cpu_name();
  report.origin = "remote-touch " + version();
  return report;
}

}  // namespace remote_touch
