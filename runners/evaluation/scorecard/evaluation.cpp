#include "runners/evaluation/scorecard/evaluation.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/trace/columns.h"
#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {
namespace {

// Measures one run twice on one thread, at the noise level kCostLevel if there are levels, and returns the
// faster one. Every point of a frame is computed before the frame is passed to the renderer, so the times do
// not contain the generation of noise. Returns NaN if the run ends with an error. Throws Interrupted.
Cost measured_cost(const BenchmarkSweep& sweep, const std::string& scene, const std::string& method,
                   const Kernels& kernels, const std::atomic<bool>* stop) {
  const std::size_t cell = std::min(kCostLevel, sweep.sweep.plan().cell_count() - 1);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Cost best{scene, method, kNone, kNone};
  try {
    for (int round = 0; round < 2; ++round) {
      std::vector<double> ticks, frames;
      SimulationOptions options;
      options.kernels = &kernels, options.stop = stop, options.generate_all_points = true;
      options.step_duration_s = &ticks, options.frame_duration_s = &frames;
      simulate(sweep.sweep.experiment(cell, 0), options);
      if (!(mean(ticks) >= best.tick_s)) best.tick_s = mean(ticks), best.frame_s = mean(frames);
    }
  } catch (const std::exception&) {
    return {scene, method, kNone, kNone};  // the sweep's file contains the error
  }
  return best;
}

// Returns build, instruction set and processor.
TextAttributes cost_origin(const Kernels& kernels) {
  TextAttributes origin = provenance("", "", kernels.isa);
  std::erase_if(origin, [](const auto& one) { return one.first == "config" || one.first == "command"; });
  origin.emplace_back("cpu", cpu_name());
  return origin;
}

const Cost* find_cost(const std::vector<Cost>& costs, const std::string& scene, const std::string& method) {
  for (const Cost& cost : costs)
    if (cost.scene == scene && cost.method == method) return &cost;
  return nullptr;
}

// Returns true if the file is the trace of this experiment, which an earlier call of the same build wrote.
// Another build or another failure has another source digest or configuration.
bool is_there(const std::filesystem::path& file, const Experiment& experiment, const StoredSweep& stored) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(file, unreachable)) return false;
  try {
    const Hdf5Reader reader(file);
    const TextAttributes& attributes = reader.attributes();
    return attribute(attributes, "config") == experiment.to_json() &&
           attribute(attributes, "source_digest") == attribute(stored.attributes, "source_digest");
  } catch (const InputError&) {
    return false;  // a damaged file is replaced
  }
}

// Replays the typical failure, see typical_failure(), at the lowest noise level that has failures, into
// FOLDER/traces/NAME.h5, unless that file is the trace of this run already. If that run ended with an error,
// no trace is made and `error` is set. Returns none if every run succeeded.
std::optional<FailureTrace> trace_failure(const BenchmarkSweep& sweep, const StoredSweep& stored,
                                          const std::vector<Bound>& success,
                                          const std::filesystem::path& folder, const Kernels& kernels,
                                          const std::atomic<bool>* stop) {
  const SweepResult& result = stored.result;
  for (std::size_t level = 0; level < result.cell_count(); ++level) {
    const long found = typical_failure(result, success, level);
    if (found < 0) continue;
    const auto run = static_cast<std::size_t>(found);
    if (result.state[run] == RunState::failed)
      return FailureTrace{level, result.replicate_of(run), {}, {}, result.error[run]};
    FailureTrace failure{level, result.replicate_of(run), "traces/" + sweep.name + ".h5", {}};
    failure.command = program_text() + " replay runs/" + sweep.name + ".h5 " + option_of_run(result, run) +
                      " -o " + failure.file;
    const std::filesystem::path file = folder / failure.file;
    SimulationOptions options;
    options.kernels = &kernels, options.stop = stop;
    if (!is_there(file, sweep.sweep.experiment(level, failure.replicate), stored))
      replay_run(stored.attributes, sweep.sweep, run, options, file);
    return failure;
  }
  return {};
}

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
struct OneThread {
  OneThread() { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(threads); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;
  const int threads = omp_get_max_threads();
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

void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs,
                 const TextAttributes& origin) {
  Json list = Json::array();
  for (const Cost& cost : costs)
    list.push_back(
        {{"scene", cost.scene}, {"method", cost.method}, {"tick_s", cost.tick_s}, {"frame_s", cost.frame_s}});
  Json all = Json::object();
  for (const auto& [name, value] : origin) all[name] = value;
  all["costs"] = list;
  write_file_atomically(file, all.dump(1) + "\n");  // null: not a finite number
}

std::vector<Cost> read_costs(const std::filesystem::path& file, const TextAttributes& origin) {
  const Json all = json_in_file(file);
  std::vector<Cost> costs;
  if (!all.is_object() || !all.contains("costs") || !all["costs"].is_array()) return costs;
  for (const char* name : {"source_digest", "isa", "cpu"})
    if (all.value(name, Json()) != attribute(origin, name)) return costs;
  const Json& list = all["costs"];
  const auto seconds = [](const Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  for (const Json& item : list) {
    if (!item.is_object() || !item.value("scene", Json()).is_string() ||
        !item.value("method", Json()).is_string())
      return {};
    const double tick_s = seconds(item.value("tick_s", Json()));
    if (std::isnan(tick_s)) continue;  // the run ended with an error: it is measured again
    costs.push_back({item["scene"].get<std::string>(), item["method"].get<std::string>(), tick_s,
                     seconds(item.value("frame_s", Json()))});
  }
  return costs;
}

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
  const auto run = std::ranges::find(scene.measures, "energy_injected", &JudgedMeasure::name);
  const auto update = std::ranges::find(scene.measures, "mean_energy_per_update", &JudgedMeasure::name);
  if (run == scene.measures.end() || update == scene.measures.end()) return {};
  std::vector<std::vector<EnergySummary>> laws(run->at_level.size());
  for (std::size_t c = 0; c < laws.size(); ++c)
    for (std::size_t i = 0; i < scene.noise_m.size(); ++i) {
      Estimate cycle = run->at_level[c][i];
      for (double* energy : {&cycle.value, &cycle.low, &cycle.high}) *energy /= kPassivityCycles;
      laws[c].push_back({cycle, update->at_level[c][i].value});
    }
  return laws;
}

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
