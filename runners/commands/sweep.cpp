#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/sweep_in_progress.h"
#include "analysis/whole_file.h"
#include "core/input_error.h"
#include "runners/commands/commands.h"
#include "runners/commands/progress.h"
#include "runners/commands/sweep_summary.h"
#include "runners/json_parameters.h"
#include "runners/provenance.h"
#include "runners/simulation.h"
#include "runners/sweep_run.h"

namespace remote_touch {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What makes the result again: no output path, threads or shard.
std::string normalised(const SweepRequest& request) {
  std::string command = "remote-touch sweep " + request.sweep;
  for (const std::string& assignment : request.overrides) command += " --set " + assignment;
  return command;
}

std::string with_shard(std::string output, const Shard& shard) {
  const std::string mark = "{shard}";
  if (const auto at = output.find(mark); at != std::string::npos)
    output.replace(at, mark.size(), std::to_string(shard.index) + "of" + std::to_string(shard.count));
  return output;
}

TextAttributes attributes_of(const Sweep& sweep, const SweepRequest& request, const Shard& shard) {
  TextAttributes list = provenance(sweep.to_json(), normalised(request), "");
  if (shard.count > 1) list.emplace_back("shard", shard.text());
  return list;
}

std::string value_of(const TextAttributes& attributes, const std::string& name) {
  for (const auto& [known, value] : attributes)
    if (known == name) return value;
  return {};
}

// The first place where two configurations differ.
std::string difference(const std::string& theirs, const std::string& ours) {
  const Json a = parse_json(theirs, "config"), b = parse_json(ours, "config");
  const Json changes = Json::diff(a, b);
  return changes.empty() ? "" : changes.front()["path"].get<std::string>();
}

// A file of another sweep, another shard or another build is not touched.
void require_same(const std::string& file, const TextAttributes& theirs, const TextAttributes& ours) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(file, what + "; allowed a file of the same sweep, shard and build, or a new file");
  };
  if (value_of(theirs, "config") != value_of(ours, "config"))
    refuse("is of another configuration, first at " +
           difference(value_of(theirs, "config"), value_of(ours, "config")));
  for (const char* name : {"shard", "version", "git_commit", "git_dirty", "compiler", "flags"})
    if (value_of(theirs, name) != value_of(ours, name))
      refuse(std::string("has ") + name + " \"" + value_of(theirs, name) + "\", not \"" +
             value_of(ours, name) + "\"");
}

// A few runs spread over the sweep, for at most about two seconds.
double seconds_per_run(const Sweep& sweep, const SweepResult& result, const CommandLine& line) {
  const std::vector<std::size_t> runs = result.runs_in(RunState::pending);
  SimulationOptions options;
  options.kernels = line.kernels;
  options.stop = line.stop;
  const auto start = Clock::now();
  std::size_t done = 0;
  constexpr std::size_t kSamples = 16;
  for (; done < std::min(kSamples, runs.size()) && seconds_since(start) < 2; ++done) {
    // An odd multiplier visits the samples out of order, so that stopping early leaves a fair choice.
    const std::size_t sample = 7 * done % kSamples;
    const std::size_t run = runs[sample * runs.size() / kSamples];
    simulate(sweep.experiment(result.cell_of(run), result.replicate_of(run)), options);
  }
  return done == 0 ? 0 : seconds_since(start) / static_cast<double>(done);
}

int dry_run(const Sweep& sweep, const SweepResult& result, const TextAttributes& attributes,
            const CommandLine& line) {
  const std::size_t runs = result.runs_in(RunState::pending).size();
  const double seconds = seconds_per_run(sweep, result, line);
  std::printf("%s\n  %s cells, %zu runs to do, all valid\n", sweep.title().c_str(),
              extent_text(result).c_str(), runs);
  if (const auto rule = sweep.refinement())
    std::printf("  refinement: up to %llu runs in all\n", static_cast<unsigned long long>(rule->budget));
  std::printf("  about %.3g s on %d threads (%.3g ms a run, some tried)\n",
              seconds * static_cast<double>(runs) / omp_get_max_threads(), omp_get_max_threads(),
              1e3 * seconds);
  std::printf("  file: %.3g MB while it runs, less when it is finished\n",
              1e-6 * static_cast<double>(size_in_progress(result, attributes)));
  return kDone;
}

// What an earlier call left in the file goes on; failed runs are tried again. Only what runs gave is taken
// from it: the rest is known.
bool take_over(const std::string& file, const TextAttributes& attributes, SweepResult& result,
               TextAttributes& kept) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(file, unreachable)) return false;
  StoredSweep stored = read_sweep(file);
  require_same(file, stored.attributes, attributes);
  SweepResult& earlier = stored.result;
  if (earlier.run_count() != result.run_count() || earlier.measures.size() != result.measures.size() ||
      earlier.round.size() != result.round.size())
    throw InputError(file, "damaged (its arrays do not fit its configuration); allowed a new file");
  for (std::size_t i = 0; i < result.measures.size(); ++i)
    result.measures[i].values = std::move(earlier.measures[i].values);
  for (std::size_t run = 0; run < result.run_count(); ++run)
    if (result.state[run] != RunState::elsewhere) result.state[run] = earlier.state[run];
  result.round = std::move(earlier.round);
  result.error = std::move(earlier.error);
  kept = std::move(stored.attributes);
  const auto failed = result.runs_in(RunState::failed);
  for (const std::size_t run : failed) result.state[run] = RunState::pending, result.error[run].clear();
  return stored.in_progress && failed.empty();
}

// Does and stores what is pending.
void do_round(const Sweep& sweep, const std::string& file, const TextAttributes& attributes,
              bool already_there, const CommandLine& line, SweepResult& result) {
  SweepInProgress storage(file, result, attributes, already_there);
  const std::size_t pending = result.runs_in(RunState::pending).size();
  const std::size_t earlier = result.runs_in(RunState::done).size(), total = earlier + pending;
  Progress progress(sweep.title(), line.quiet);
  auto flushed = Clock::now();
  std::size_t done = earlier;
  SweepRunOptions options{line.kernels, line.stop, [&](std::size_t run) {
                            storage.record(result, run);
                            progress.update(++done, total, earlier, "runs");
                            if (seconds_since(flushed) < 1) return;
                            storage.flush();
                            flushed = Clock::now();
                          }};
  do_pending_runs(sweep, result, options);
  storage.flush();
}

}  // namespace

int command_sweep(const CommandLine& line, const SweepRequest& request) {
  if (request.threads > 0) omp_set_num_threads(request.threads);
  const Shard shard =
      request.shard.empty() ? shard_from_environment().value_or(Shard{}) : parse_shard(request.shard);
  const Sweep sweep = Sweep::load(request.sweep, request.overrides);
  SweepResult result = sweep.plan(shard);
  TextAttributes attributes = attributes_of(sweep, request, shard);
  if (request.dry_run) return dry_run(sweep, result, attributes, line);

  const std::string file = with_shard(request.output, shard);
  require_writable(file);
  bool already_there = take_over(file, attributes, result, attributes);
  // Shards do the first round; refinement looks at all of them, so it begins on the merged file.
  const auto more = [&] {
    if (shard.count > 1 || !add_round(sweep, result)) return false;
    already_there = false;  // the file knows nothing of the new round
    return true;
  };
  bool any = false;
  try {
    while (!result.runs_in(RunState::pending).empty() || more()) {
      do_round(sweep, file, attributes, already_there, line, result);
      any = true;
    }
  } catch (const Interrupted&) {
    std::fprintf(
        stderr, "remote-touch: interrupted; %zu finished runs are kept in %s, and the same command goes on\n",
        result.runs_in(RunState::done).size(), file.c_str());
    return kInterrupted;
  }
  std::error_code unreachable;  // a shard without cells is a file too
  if (any || already_there || !std::filesystem::exists(file, unreachable))
    write_sweep(file, result, attributes);
  else
    std::printf("%s: nothing left to do\n", file.c_str());
  return print_summary(file, result);
}

}  // namespace remote_touch
