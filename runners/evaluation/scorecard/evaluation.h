// Makes the report of a scorecard from its finished runs.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/evaluation/scorecard/scorecard.h"
#include "scenarios/files/text_file.h"

namespace remote_touch {

// The cost of renderers: wall-clock time of ticks and frames on this machine. It varies from run to run, so
// it is stored apart from all results.
struct Cost {
  std::string scene, method;
  double tick_s = 0;   // mean of a tick
  double frame_s = 0;  // mean of on_frame(); NaN without frames
};
inline constexpr std::size_t kCostLevel = 3;  // measured at this index in scorecard_noise_m(): 0.6 r_c

// The costs are stored in a JSON file beside the results, so that scorecard.json of a finished scorecard does
// not change. origin: build, instruction set and processor; costs of another origin are not read, nor
// are those of runs that ended with an error. read_costs() returns none for a file that does not exist or
// cannot be used.
void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs,
                 const TextAttributes& origin);
std::vector<Cost> read_costs(const std::filesystem::path& file, const TextAttributes& origin);

// A typical failure of each method in each scene, run again as a full trace.
struct FailureTrace {
  std::size_t level = 0;  // lowest noise level with a failure
  int replicate = 0;
  std::string file;     // relative to the scorecard's folder; empty: the run ended with an error, no trace
  std::string command;  // command that makes the trace, to be run in that folder
  std::string error = {};
  std::string page = {};  // page that shows the trace, relative to the folder; empty: not requested
};

// The results of a scorecard's runs: its numbers, failures, costs and the audit of passivity.
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

// The scores of all scenes, with comparisons corrected for each other. pre: do_sweeps() has finished.
Scorecard scores_of(const BenchmarkPlan& plan);

// Reads all runs, scores them, traces typical failures and measures the costs that no earlier call measured.
// progress: number of scenes done, and of all. Throws Interrupted. pre: do_sweeps() has finished.
ScorecardReport evaluate(const BenchmarkPlan& plan, const Kernels& kernels, const std::atomic<bool>* stop,
                         const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace remote_touch
