#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/storage/atomic_file.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/presentation/result_pages.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/work_pool.h"

namespace remote_touch {
namespace {

struct ScorecardRequest {
  std::vector<std::string> methods, scenes;  // empty: all
  std::string folder;
  int seeds = 10;
  int threads = 0;    // 0: as OpenMP decides
  bool view = false;  // also make pages of the failures
};

constexpr const char* kStoredCard = "data/scorecard.h5";

struct ScorecardStoreRequest : ScorecardRequest {
  std::string file = kStoredCard;
};

struct ScorecardCheckRequest {
  std::vector<std::string> methods, scenes;  // empty: all that are stored
  std::string folder;
  std::string file = kStoredCard;
  int threads = 0;
};

struct ScorecardSummaryRequest {
  std::string file = kStoredCard;
};

struct ScorecardJsonRequest : ScorecardSummaryRequest {};

// Steps that the commands of a scorecard share: doing its runs, and reporting on them.

constexpr std::size_t kPageOfFailure = 3'000'000;  // bytes of one page; there may be hundreds of pages

struct NoteOfRuns {
  std::string kind, first;  // first: a run that has it, as arguments of `replay`
  std::size_t runs;
};

void add_notes(const SweepResult& result, const std::string& file, std::vector<NoteOfRuns>& notes) {
  for (const NoteCount& count : note_counts(result)) {
    const auto found = std::find_if(notes.begin(), notes.end(),
                                    [&](const NoteOfRuns& note) { return note.kind == count.kind; });
    if (found != notes.end())
      found->runs += count.runs;
    else
      notes.push_back({count.kind, file + " " + option_of_run(result, count.first), count.runs});
  }
}

// Does the runs that are left, with a line of progress. Throws Interrupted.
void do_scorecard_runs(const CommandLine& line, const std::vector<BenchmarkSweep>& sweeps) {
  Progress progress("scorecard", line.quiet);
  do_sweeps(sweeps, *line.kernels, line.stop, [&](std::size_t done, std::size_t all, double fraction) {
    progress.update((static_cast<double>(done) + fraction) / static_cast<double>(all));
  });
}

// Makes a page beside the trace of each failure, and notes it in the report. Throws Interrupted.
void make_failure_pages(const CommandLine& line, const std::string& folder, ScorecardReport& report) {
  std::vector<FailureTrace*> failures;
  for (auto& of_scene : report.failures)
    for (auto& one : of_scene)
      if (one && !one->file.empty()) failures.push_back(&*one);
  Progress progress("pages", line.quiet);
  ViewOptions options;
  options.max_bytes = kPageOfFailure;
  options.kernels = line.kernels, options.stop = line.stop;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    std::filesystem::path page = failures[i]->file;
    page.replace_extension(".html");
    write_file_atomically(folder / page,
                          trace_page({std::filesystem::path(folder) / failures[i]->file}, options).html);
    failures[i]->page = page.string();
    progress.update(i + 1, failures.size(), 0, "pages");
  }
}

// Prints for each kind of note how many runs have it, and the command that shows the first run. Prints how
// many runs ended with an error, and the first one; they count as no success. Returns kDone, or kCheckFailed
// if runs ended with an error.
int report_runs(const std::vector<BenchmarkSweep>& sweeps) {
  std::vector<NoteOfRuns> notes;
  std::size_t done = 0, failed = 0;
  std::string first_error;
  for (const BenchmarkSweep& sweep : sweeps) {
    const SweepResult result = read_sweep(sweep.file).result;
    done += result.runs_in(RunState::done).size();
    add_notes(result, sweep.file.string(), notes);
    const auto runs = result.runs_in(RunState::failed);
    if (!runs.empty() && first_error.empty()) first_error = sweep.name + ": " + result.error[runs.front()];
    failed += runs.size();
  }
  for (const NoteOfRuns& note : notes)
    std::printf("note: %zu of %zu runs: %s (the first: replay %s)\n", note.runs, done,
                text_of_kind(note.kind).c_str(), printable(note.first).c_str());
  if (failed == 0) return kDone;
  std::printf("%zu runs failed; the first: %s\n", failed, first_error.c_str());
  return kCheckFailed;
}

// Prints that the runs are kept. Returns kInterrupted.
int report_interrupted(const std::string& folder) {
  std::fprintf(stderr, "%s: interrupted; finished runs are kept in %s, and the same command continues\n",
               program_identity().name.c_str(), folder.c_str());
  return kInterrupted;
}

// Throws InputError if a method or a scene is one of the files that are written to the folder. It may be any
// other file there.
void require_inputs_kept(const ScorecardRequest& request) {
  for (const auto* names : {&request.methods, &request.scenes})
    for (const std::string& name : *names)
      for (const char* written : {kScorecardFile, "scorecard.json", "costs.json"})
        require_different_file(std::filesystem::path(request.folder) / written, name);
}

// Returns the successes of each method in a scene; the headings are the noise.
ReportTable success_table(const Scorecard& card, const SceneScore& scene) {
  ReportTable table;
  for (std::size_t c = 0; c < card.methods.size(); ++c) {
    ReportRow& row = table.rows.emplace_back();
    row.show("noise in mm", card.methods[c]);
    for (std::size_t level = 0; level < scene.noise_m.size(); ++level) {
      const Proportion& fraction = scene.success[c].at_level[level];
      const double noise_m = scene.noise_m[level];
      row.show(std::isnan(noise_m) ? "own" : formatted("%.3g", 1e3 * noise_m),
               std::to_string(fraction.events) + "/" + std::to_string(fraction.runs), fraction.events);
    }
  }
  return table;
}

void print(const ScorecardReport& report) {
  const Scorecard& card = report.card;
  if (!card.scenes.empty()) std::printf("successes/runs of each method, over the noise\n");
  for (const SceneScore& scene : card.scenes) {
    std::printf("%s\n", scene.name.c_str());
    if (!scene.truth.empty()) std::printf("  truth: %s\n", printable(scene.truth).c_str());
    std::fputs(success_table(card, scene).text().c_str(), stdout);
  }
  if (card.tests > 0)
    std::printf(
        "%lld comparisons of two methods, corrected together (Holm): significant from %lld pairs of runs on\n",
        static_cast<long long>(card.tests), static_cast<long long>(card.least_pairs));
  for (const auto& [name, why] : report.skipped)
    std::printf("%s\n  skipped: %s\n", name.c_str(), why.c_str());
}

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

int command_scorecard_json(const CommandLine&, const ScorecardJsonRequest& request) {
  std::fputs(stored_json(request.file).c_str(), stdout);
  return kDone;
}

// Options of every command that runs a scorecard.
template <class Request>
void add_scorecard_options(CLI::App* command, Request& request, const char* all) {
  const std::string unless = std::string(" (default: ") + all + ")";
  command->add_option("methods", request.methods, "names from `remote-touch list`, or JSON files" + unless);
  command->add_option("--scene", request.scenes, "a name from `remote-touch list`, or a JSON file" + unless);
  command->add_option("-o,--output", request.folder, "the folder to write to, or to resume; required");
  command->add_option("--threads", request.threads, "number of threads (default: OMP_NUM_THREADS, or all)")
      ->check(CLI::Range(1, kMaxThreads));
}

void add_seeds(CLI::App* command, ScorecardRequest& request) {
  command
      ->add_option("--seeds", request.seeds,
                   "number of runs of each scene and noise level, each with its own noise")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
}

}  // namespace

void add_scorecard(Subcommands& commands) {
  auto [command, scorecard] = commands.add(
      "scorecard",
      "compare renderers over many scenes and noise levels; writes HDF5 files, and JSON for scripts/plot",
      command_scorecard);
  add_scorecard_options(command, *scorecard, "all");
  add_seeds(command, *scorecard);
  command->add_flag("--view", scorecard->view,
                    "also make a page of each typical failure, as `remote-touch view` does");
  Subcommands below{*command, commands.line, commands.act, commands.threads};
  auto [check_command, check] = below.add(
      "check", "compare with the stored scorecard; exit code 0: agrees, 1: differs, 2: not comparable",
      command_scorecard_check);
  add_scorecard_options(check_command, *check, "all that are stored");
  check_command->add_option("--stored", check->file, "the stored scorecard")->capture_default_str();
  auto [store_command, store] =
      below.add("store", "store the numbers of a scorecard for `scorecard check`", command_scorecard_store);
  add_scorecard_options(store_command, *store, "all");
  add_seeds(store_command, *store);
  store_command->add_option("--stored", store->file, "the file to write")->capture_default_str();
  auto [summary_command, summary] = below.add("summary", "print what the stored scorecard says, as Markdown",
                                              command_scorecard_summary, kNoThreads);
  summary_command->add_option("--stored", summary->file, "the stored scorecard")->capture_default_str();
  auto [json_command, json] = below.add(
      "json", "print the stored scorecard as JSON, from which scripts/plot makes a page without runs",
      command_scorecard_json, kNoThreads);
  json_command->add_option("--stored", json->file, "the stored scorecard")->capture_default_str();
}

}  // namespace remote_touch
