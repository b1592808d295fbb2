// The commands about sweeps: `sweep`, `merge` and `analyse`.
#include <omp.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/presentation/export_formats.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_run.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string with_shard(std::string output, const Shard& shard) {
  const std::string mark = "{shard}";
  if (const auto at = output.find(mark); at != std::string::npos)
    output.replace(at, mark.size(), std::to_string(shard.index) + "of" + std::to_string(shard.count));
  return output;
}

TextAttributes attributes_of(const Sweep& sweep, const SweepRequest& request, const Shard& shard) {
  TextAttributes list = provenance(sweep.to_json(), Recipe{"sweep", request.sweep, request.overrides}, "",
                                   input_hashes(sweep.inputs()));
  if (shard.count > 1) list.emplace_back("shard", shard.text());
  return list;
}

constexpr std::size_t kSamples = 24;  // runs that a dry run tries
constexpr double kSample_s = 2;       // time after which it begins no further run

// Returns the numbers of some pending runs: the first and the last, and others. Their distances are no
// multiples of the length of an axis, so that all values of all axes have a chance.
std::vector<std::uint64_t> spread_runs(const SweepResult& plan) {
  const std::vector<std::size_t> places = plan.runs_in(RunState::pending);
  std::vector<std::uint64_t> runs;
  const auto add = [&](std::size_t i) {
    const std::uint64_t run = plan.run_at(places[i]);
    if (std::find(runs.begin(), runs.end(), run) == runs.end()) runs.push_back(run);
  };
  if (!places.empty()) add(0), add(places.size() - 1);
  constexpr double kGoldenRatio = 0.6180339887498949;
  for (std::size_t k = 1; !places.empty() && k <= kSamples; ++k)
    add(static_cast<std::size_t>(std::fmod(static_cast<double>(k) * kGoldenRatio, 1.0) *
                                 static_cast<double>(places.size())));
  return runs;
}

// Some runs, made as the sweep makes them: side by side, each on one thread.
struct Sample {
  std::vector<double> seconds = {};  // duration of each run that was tried
  SweepResult tried;                 // the others are pending

  double mean_s() const {
    return std::accumulate(seconds.begin(), seconds.end(), 0.0) / static_cast<double>(seconds.size());
  }
};
Sample sample_runs(const Sweep& sweep, const SweepResult& plan, const CommandLine& line) {
  const std::vector<std::uint64_t> wanted = spread_runs(plan);
  std::vector<std::uint64_t> runs = wanted;
  std::sort(runs.begin(), runs.end());
  Sample sample{{}, sweep.part(runs)};
  if (runs.empty()) return sample;
  SweepRunOptions options{line.kernels, line.stop};
  const auto start = Clock::now();
  // The first run of a process also reads files and fills caches; it is made once more, unless it is long.
  do_run(sweep, options, plan.cell_of(wanted.front()), plan.replicate_of(wanted.front()));
  const double first_s = seconds_since(start);
  if (first_s > kSample_s) sample.seconds.push_back(first_s);
  std::mutex one_at_a_time;
  options.runs = [&](std::size_t count, const auto& make) {
    side_by_side(count, [&](std::size_t i) {
      if (seconds_since(start) > kSample_s) return;
      const auto begin = Clock::now();
      make(static_cast<std::size_t>(std::lower_bound(runs.begin(), runs.end(), wanted[i]) - runs.begin()));
      const double seconds = seconds_since(begin);
      const std::lock_guard lock(one_at_a_time);
      sample.seconds.push_back(seconds);
    });
  };
  do_pending_runs(sweep, sample.tried, options);
  return sample;
}

int print_interrupted(const std::string& file, std::size_t finished) {
  std::fprintf(stderr, "%s: interrupted; %zu finished runs are kept in %s, and the same command continues\n",
               program_identity().name.c_str(), finished, printable(file).c_str());
  return kInterrupted;
}

// The work that a call would do.
struct Work {
  std::size_t runs = 0;     // runs to do
  std::size_t done = 0;     // runs that the file has
  std::string file_text;    // size of the file
  const SweepResult& plan;  // some or all of the runs, pending
};

int dry_run(const Sweep& sweep, const Work& work, const CommandLine& line, const SweepRequest& request) {
  const Sample sample = sample_runs(sweep, work.plan, line);
  const std::size_t runs = work.runs;
  std::printf("%s\n  %s cells, %zu runs to do, all valid", sweep.title().c_str(),
              extent_text(work.plan).c_str(), runs);
  if (work.done > 0) std::printf("; %zu are done", work.done);
  if (const auto rule = sweep.refinement())
    std::printf("\n  refinement: up to %llu runs in all", static_cast<unsigned long long>(rule->budget));
  if (sample.seconds.empty()) {
    std::printf("\n  no time to estimate: no run was tried");
  } else {
    const auto [least, most] = std::minmax_element(sample.seconds.begin(), sample.seconds.end());
    std::printf("\n  about %.2g s on %d threads (%.3g ms a run, %.3g to %.3g in the %zu that were tried)",
                sample.mean_s() * static_cast<double>(runs) / omp_get_max_threads(), omp_get_max_threads(),
                1e3 * sample.mean_s(), 1e3 * *least, 1e3 * *most, sample.seconds.size());
  }
  if (const std::size_t failed = sample.tried.runs_in(RunState::failed).size(); failed > 0)
    std::printf("; %zu of those tried failed", failed);
  std::printf("\n  file: %s\n", work.file_text.c_str());
  for (const std::string& note : note_lines(sample.tried))
    std::printf("  note on the runs that were tried: %s\n", note.c_str());
  print_replaced(request.overrides);
  if (request.strict) refuse_notes(note_lines(sample.tried));
  return kDone;
}

int dry_run_of_runs(const Sweep& sweep, const SweepResult& left, const SweepPlan& plan,
                    const CommandLine& line, const SweepRequest& request) {
  const std::string text =
      formatted("%.3g MB while it runs, less when it is finished",
                1e-6 * static_cast<double>(size_in_progress(left, plan.made.attributes)));
  return dry_run(sweep, {count_of(left, RunState::pending), plan.done(), text, left}, line, request);
}

// Tries first replicates of cells of the shard.
int dry_run_of_tally(const Sweep& sweep, const Shard& shard, const SweepPlan& plan, const CommandLine& line,
                     const SweepRequest& request) {
  const SweepGrid outline = sweep.outline();
  const std::size_t cells = shard.cells_of(outline.cell_count());
  const std::size_t left = plan.total(shard) - plan.done();
  std::vector<std::uint64_t> first_runs;
  for (std::size_t i = 0; left > 0 && i < cells; ++i) first_runs.push_back(outline.run(shard.cell(i), 0));
  const SweepResult of_cells = sweep.part(std::move(first_runs));
  const std::string text = "a tally of " + std::to_string(cells) + (cells == 1 ? " cell" : " cells");
  return dry_run(sweep, {left, plan.done(), text, of_cells}, line, request);
}

// Does what is left of a session, with progress. Returns false if it was interrupted.
bool run_session(const CommandLine& line, const SweepRequest& request, const std::string& file,
                 SweepSession& session) {
  Progress progress(request.sweep, line.quiet);
  try {
    const bool any = session.run(*line.kernels, line.stop, [&](auto done, auto total, auto earlier) {
      progress.update(done, total, earlier, "runs");
    });
    if (!any) std::printf("%s: nothing left to do\n", printable(file).c_str());
  } catch (const Interrupted&) {
    return false;
  }
  print_replaced(request.overrides);
  return true;
}

}  // namespace

int command_sweep(const CommandLine& line, const SweepRequest& request) {
  require_own_kind(request.sweep, "sweep");
  const auto value_of = [](const char* variable) -> const char* { return std::getenv(variable); };
  const Shard shard =
      request.shard.empty() ? shard_from_environment(value_of).value_or(Shard{}) : parse_shard(request.shard);
  const Sweep sweep = Sweep::load(request.sweep, request.overrides);
  const std::string file = with_shard(request.output, shard);
  if (file.empty() && !request.dry_run)
    throw InputError("--output", "is required; see remote-touch sweep --help");
  if (!file.empty()) require_writable(file);
  const TextAttributes attributes = attributes_of(sweep, request, shard);
  if (request.dry_run) {
    const SweepPlan plan = plan_in_file(sweep, shard, attributes, file);
    const auto* const left = std::get_if<SweepResult>(&plan.made.kept);
    return left ? dry_run_of_runs(sweep, *left, plan, line, request)
                : dry_run_of_tally(sweep, shard, plan, line, request);
  }
  SweepSession session(sweep, shard, attributes, file);
  if (!run_session(line, request, file, session)) return print_interrupted(file, session.done());
  const auto print = [&](const auto& made) {
    const int code = print_summary(file, made);
    if (const std::string note = note_on_equal_runs(made, sweep.to_json()); !note.empty())
      std::puts(note.c_str());
    if (request.strict) refuse_notes(note_lines(made));
    return code;
  };
  return std::visit(print, session.kept().kept);
}

int command_merge(const CommandLine& line, const MergeCommand& command) {
  const FileLock lock = lock_output(line, command.output, {});
  std::vector<std::string> notes;
  const MergeRequest request{command.shards, command.output, command.partial ? Partial::yes : Partial::no,
                             line.force, [&](const std::string& note) { notes.push_back(note); }};
  if (is_tally(Hdf5Reader(command.shards.front())))
    return print_summary(command.output, merge_tallies(request));
  std::optional<SweepSummary> summary;
  const std::string digest = merge_shards(request, [&](const SweepResult& block) {
    if (!summary) summary.emplace(grid_of(block));
    summary->add(block);
  });
  const int code = summary->print(command.output, digest);
  for (const std::string& note : notes) std::printf("  note: %s\n", printable(note).c_str());
  return code;
}

namespace {

// Answers questions about a finished sweep: limits, means and differences, as text, CSV or HDF5.

// See SweepQuestion in runners/sweep/sweep_answer.h.
struct AnalyseRequest {
  std::string sweep;
  std::string limit, along, between, direction;  // empty: chosen
  double threshold = 0.5, level = 0.5;
  std::vector<std::string> means, differences, by;
  std::string output;  // .h5 or .csv; empty: none
};

SweepQuestion question_of(const AnalyseRequest& request) {
  return {request.limit, request.along,       request.threshold, request.level,    request.means,
          request.by,    request.differences, request.between,   request.direction};
}

// Returns the command without the output.
std::string command_of(const AnalyseRequest& request) {
  std::vector<std::string> words = program_words();
  words.insert(words.end(), {"analyse", request.sweep});
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  const auto add_number = [&](const char* option, double value) {
    const std::string text = formatted("%.17g", value);
    if (value != 0.5) add(option, text);
  };
  add("--limit", request.limit), add("--along", request.along);
  add_number("--above", request.threshold), add_number("--level", request.level);
  for (const std::string& measure : request.means) add("--mean", measure);
  for (const std::string& axis : request.by) add("--by", axis);
  for (const std::string& measure : request.differences) add("--difference", measure);
  add("--between", request.between), add("--direction", request.direction);
  return shell_command(words);
}

struct Answer {
  Figure figure;
  std::string config, digest;       // configuration and digest of the sweep
  std::size_t done = 0, asked = 0;  // runs that are finished, and that the sweep should have
  std::vector<std::string> notes;
  std::string distrust = {};  // see distrust_of()
};

Answer answer_to(const AnalyseRequest& request) {
  const KeptSweep stored = read_kept_sweep(request.sweep, Extent::whole);
  const std::string config = attribute(stored.attributes, "config");
  const auto answer = [&](const auto& kept) {
    std::vector<std::string> notes = note_lines(kept);
    if (!stored.warning.empty()) notes.push_back(stored.warning);
    return Answer{sweep_answer(kept, config, question_of(request)),
                  config,
                  digest(kept),
                  count_of(kept, RunState::done),
                  kept.run_count() - count_of(kept, RunState::not_sampled),
                  std::move(notes),
                  distrust_of(stored.attributes)};
  };
  return std::visit(answer, stored.kept);
}

void write_hdf5(const CommandLine& line, const AnalyseRequest& request, const Answer& answer) {
  const FileLock lock = lock_output(line, request.output, {request.sweep});
  TextAttributes attributes = provenance(answer.config, command_of(request), "");
  attributes.emplace_back("sweep_digest", answer.digest);
  Figure figure = answer.figure;
  if (!answer.distrust.empty()) figure.caption += (figure.caption.empty() ? "" : " ") + answer.distrust + ".";
  write_figure(request.output, figure, attributes);
}

// Writes the tables without those of single curves, whose rows the others have, too.
void write_tables(const CommandLine& line, const AnalyseRequest& request, const Figure& answer) {
  std::vector<Table> tables = answer.tables;
  std::erase_if(tables, [&](const Table& table) { return is_of_curve(answer, table); });
  const FileLock lock(request.output);
  NewFiles files("the tables");
  const auto require_allowed = [&](const std::filesystem::path& file, const std::string& opening) {
    require_export(line, file.string(), {request.sweep}, opening);
  };
  const Hdf5Reader sweep(request.sweep);
  write_csv(tables, {sweep, request.output, files, require_allowed, line.kernels, line.stop});
  files.finish();
}

int command_analyse(const CommandLine& line, const AnalyseRequest& request) {
  const std::string ending = std::filesystem::path(request.output).extension().string();
  if (!request.output.empty() && ending != ".h5" && ending != ".csv")
    throw InputError("--output " + request.output, "expected a file that ends with .h5 or .csv");
  const Answer answer = answer_to(request);
  if (ending == ".h5") write_hdf5(line, request, answer);
  if (ending == ".csv") write_tables(line, request, answer.figure);
  std::fputs(answer_text(answer.figure, answer.done, answer.asked).c_str(), stdout);
  for (const std::string& note : answer.notes) std::printf("  note: %s\n", note.c_str());
  return kDone;
}

}  // namespace

void add_sweep(Subcommands& commands) {
  auto [command, sweep] = commands.add(
      "sweep", "run an experiment over a grid of parameters; the same command resumes it", command_sweep);
  command->add_option("sweep", sweep->sweep, "a name from `remote-touch list`, or a JSON file")->required();
  add_set(command, sweep->overrides, "parameter=value of the experiment, or of the sweep");
  command->add_option(
      "-o,--output", sweep->output,
      "the HDF5 file to write or to resume; {shard} is replaced by the part, for example 2of7");
  command->add_option("--threads", sweep->threads, "number of threads (default: OMP_NUM_THREADS, or all)")
      ->check(CLI::Range(1, kMaxThreads));
  command->add_option("--shard", sweep->shard,
                      "i/N: run only part i of N (default: from Slurm or mpirun, else everything)");
  command->add_flag("--dry-run", sweep->dry_run,
                    "check every cell, estimate time and file size; write nothing");
  command->add_flag("--strict", sweep->strict,
                    "a note on a run is an error: exit code 2, after all runs are stored");
}

void add_merge(Subcommands& commands) {
  auto [command, merge] =
      commands.add("merge", "merge the shards (parts) of a sweep into one file", command_merge, kNoThreads);
  command->add_option("shards", merge->shards, "the files of all shards")->required();
  command->add_option("-o,--output", merge->output, "the HDF5 file to write")->required();
  command->add_flag("--partial", merge->partial,
                    "shards may be missing or unfinished; the file states which shards it has");
}

void add_analyse(Subcommands& commands) {
  auto [command, analyse] = commands.add(
      "analyse", "answer questions about a sweep: limits, means, differences", command_analyse, kNoThreads);
  command->add_option("sweep", analyse->sweep, "the result of a sweep")->required();
  const auto add_list = [&command = command](const char* option, std::vector<std::string>& list,
                                             const char* meaning) {
    command->add_option(option, list, meaning)->delimiter(',')->allow_extra_args(false);
  };
  command->add_option(
      "--limit", analyse->limit,
      "measure of an event (default: the first that the sweep has): where does its probability cross --level?");
  command->add_option("--along", analyse->along, "axis of the limit (default: the last axis of numbers)");
  command->add_option("--above", analyse->threshold, "the event happens above this value (default 0.5)");
  command
      ->add_option("--level", analyse->level,
                   "probability of the event at the limit, between 0 and 1 (default 0.5)")
      ->check(between(0, 1));
  add_list("--mean", analyse->means, "measure whose means are wanted; may be given several times");
  add_list("--by", analyse->by, "axes of the means and differences, A,B (default: all); others are pooled");
  add_list(
      "--difference", analyse->differences,
      "measure whose differences between the values of --between are wanted; may be given several times");
  command->add_option(
      "--between", analyse->between,
      "axis whose values are compared with its first value, for --difference (default: the first axis of "
      "names) and for --limit: differences and ratios of limits");
  command
      ->add_option("--direction", analyse->direction,
                   "the event becomes more (rises) or less probable (falls) along the axis; default: as the "
                   "runs show it")
      ->check(CLI::IsMember({"rises", "falls"}));
  command->add_option("-o,--output", analyse->output,
                      "file for the tables: .h5 (also for scripts/plot) or .csv");
}

}  // namespace remote_touch
