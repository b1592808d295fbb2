#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/scorecard/benchmark_run.h"
#include "runners/evaluation/scorecard/card_folder.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/progress.h"
#include "runners/interfaces/cli/scorecard_runs.h"

namespace remote_touch {

namespace {

// Throws InputError if a method or a scene is one of the files that are written to the folder. It may be any
// other file there.
void require_inputs_kept(const ScorecardRequest& request) {
  for (const auto* names : {&request.methods, &request.scenes})
    for (const std::string& name : *names)
      for (const char* written : {kScorecardFile, "scorecard.json", "costs.json"})
        require_different_file(std::filesystem::path(request.folder) / written, name);
}

// Prints the noise of each column of a scene.
void print_levels(const std::vector<double>& noise_m, int width) {
  std::printf("  %-*s", width, "noise in mm");
  for (const double sigma_m : noise_m)
    if (std::isnan(sigma_m))
      std::printf(" %7s", "own");
    else
      std::printf(" %7.3g", 1e3 * sigma_m);
  std::printf("\n");
}

void print(const ScorecardReport& report) {
  const Scorecard& card = report.card;
  std::size_t width = 11;
  for (const std::string& method : card.methods) width = std::max(width, method.size());
  if (!card.scenes.empty()) std::printf("successes/runs of each method, over the noise\n");
  for (const SceneScore& scene : card.scenes) {
    std::printf("%s\n", scene.name.c_str());
    if (!scene.truth.empty()) std::printf("  truth: %s\n", printable(scene.truth).c_str());
    print_levels(scene.noise_m, static_cast<int>(width));
    for (std::size_t c = 0; c < card.methods.size(); ++c) {
      std::printf("  %-*s", static_cast<int>(width), card.methods[c].c_str());
      for (const Proportion& fraction : scene.success[c].at_level)
        std::printf(" %7s", (std::to_string(fraction.events) + "/" + std::to_string(fraction.runs)).c_str());
      std::printf("\n");
    }
  }
  if (card.tests > 0)
    std::printf(
        "%lld comparisons of two methods, corrected together (Holm): significant from %lld pairs of runs on\n",
        static_cast<long long>(card.tests), static_cast<long long>(card.least_pairs));
  for (const auto& [name, why] : report.skipped)
    std::printf("%s\n  skipped: %s\n", name.c_str(), why.c_str());
}

}  // namespace

int command_scorecard(const CommandLine& line, const ScorecardRequest& request) {
  if (request.folder.empty()) throw InputError("--output", "is missing: expected a folder to write to");
  require_inputs_kept(request);
  const BenchmarkPlan plan =
      plan_of(chosen_benchmark(request.methods, request.scenes, request.seeds, request.folder));
  const std::vector<BenchmarkSweep> sweeps = plan.sweeps();
  require_same_benchmark(sweeps);
  require_all_of(std::filesystem::path(request.folder) / kScorecardFile, plan);
  make_scorecard_folder(request.folder);
  require_report(line, (std::filesystem::path(request.folder) / "scorecard.json").string(), {},
                 kScorecardJson);
  try {
    do_scorecard_runs(line, sweeps);
    Progress after("traces and results", line.quiet);
    ScorecardReport report = evaluate(plan, *line.kernels, line.stop, [&](std::size_t done, std::size_t all) {
      after.update(done, all, 0, "scenes");
    });
    after.clear();
    if (request.view) make_failure_pages(line, request.folder, report);
    const std::string card_digest = write_scorecard(
        request.folder, plan, report, scorecard_command(request.methods, request.scenes, request.seeds));
    print(report);
    std::printf("%s: %zu scenes, %zu methods, digest %s\n",
                (std::filesystem::path(request.folder) / kScorecardFile).c_str(), report.card.scenes.size(),
                report.card.methods.size(), card_digest.c_str());
    const int code = report_runs(sweeps);
    std::printf("make the page: scripts/plot %s\n", request.folder.c_str());
    return code;
  } catch (const Interrupted&) {
    return report_interrupted(request.folder);
  }
}

}  // namespace remote_touch
