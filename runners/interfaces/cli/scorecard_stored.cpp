#include <cstdio>
#include <filesystem>

#include "core/parameters/input_error.h"
#include "runners/evaluation/scorecard/benchmark_run.h"
#include "runners/evaluation/scorecard/card_folder.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/scorecard_runs.h"

namespace remote_touch {

namespace {

// Does the runs of the plan, without the audit, in its folder. Returns their scores.
Scorecard scored(const CommandLine& line, const BenchmarkPlan& plan) {
  std::vector<BenchmarkSweep> sweeps;
  for (const ScenePlan& one : plan.scenes) sweeps.insert(sweeps.end(), one.sweeps.begin(), one.sweeps.end());
  require_same_benchmark(sweeps);
  make_scorecard_folder(plan.benchmark.folder.string());
  do_scorecard_runs(line, sweeps);
  for (const auto& [name, why] : plan.skipped) std::printf("skipped: %s: %s\n", name.c_str(), why.c_str());
  if (report_runs(sweeps) != kDone) std::printf("runs that failed count as no success\n");
  return scores_of(plan);
}

// Returns the requested names, or all stored names if none was requested.
std::vector<std::string> wanted(const std::vector<std::string>& names,
                                const std::vector<std::string>& stored) {
  return names.empty() ? stored : names;
}

void require_folder(const std::string& folder) {
  if (folder.empty())
    throw InputError("--output", "is missing: expected a folder for the runs, as of remote-touch scorecard");
}

}  // namespace

int command_scorecard_store(const CommandLine& line, const ScorecardStoreRequest& request) {
  require_folder(request.folder);
  const BenchmarkPlan plan =
      plan_of(chosen_benchmark(request.methods, request.scenes, request.seeds, request.folder));
  std::vector<std::string> files = request.methods;  // each is a name or a file
  files.insert(files.end(), request.scenes.begin(), request.scenes.end());
  for (const BenchmarkSweep& sweep : plan.sweeps())
    require_distinct({{"--output", sweep.file.string()}, {"--stored", request.file}});
  const FileLock lock = lock_output(line, request.file, files);
  try {
    const Scorecard card = scored(line, plan);
    const std::string config = configuration_of(plan);
    const std::string card_digest =
        write_stored_card(request.file, card, provenance(config, program_text() + " scorecard store", ""));
    std::printf("%s: %zu scenes, %zu methods, digest %s\n", printable(request.file).c_str(),
                card.scenes.size(), card.methods.size(), card_digest.c_str());
    return kDone;
  } catch (const Interrupted&) {
    return report_interrupted(request.folder);
  }
}

int command_scorecard_check(const CommandLine& line, const ScorecardCheckRequest& request) {
  require_folder(request.folder);
  const StoredCard stored = read_stored_card(request.file);
  const BenchmarkPlan plan =
      plan_of(chosen_benchmark(wanted(request.methods, stored.methods), wanted(request.scenes, stored.scenes),
                               stored.replicates, request.folder));
  try {
    const Scorecard card = scored(line, plan);
    const std::vector<std::string> list = differences(stored, plan, card);
    for (const std::string& difference : list) std::printf("differs: %s\n", difference.c_str());
    std::printf("%s: %zu scenes and %zu methods compared, %zu differences\n", printable(request.file).c_str(),
                card.scenes.size(), card.methods.size(), list.size());
    return list.empty() ? kDone : kCheckFailed;
  } catch (const Interrupted&) {
    return report_interrupted(request.folder);
  }
}

int command_scorecard_summary(const CommandLine&, const ScorecardSummaryRequest& request) {
  std::fputs(stored_summary(request.file).c_str(), stdout);
  return kDone;
}

}  // namespace remote_touch
