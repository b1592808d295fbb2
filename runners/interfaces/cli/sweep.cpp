#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/simulation/note_kinds.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/progress.h"
#include "runners/interfaces/cli/sweep_summary.h"
#include "runners/sweep/sweep_notes.h"
#include "runners/sweep/sweep_session.h"
#include "runners/sweep/tally_session.h"

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

// A few runs spread over the sweep, for at most about two seconds.
struct Sample {
  std::optional<double> seconds_per_run = {};  // empty: no run was tried
  int failed = 0;
  SweepResult tried;  // only these runs are done in it
};
Sample sample_runs(const Sweep& sweep, const SweepResult& result, const CommandLine& line) {
  const std::vector<std::size_t> places = result.runs_in(RunState::pending);
  SimulationOptions options;
  RunReport report;
  options.report = &report;
  options.kernels = line.kernels;
  options.stop = line.stop;
  const auto start = Clock::now();
  constexpr std::size_t kSamples = 16;
  std::size_t done = 0;
  Sample sample{std::nullopt, 0, result};
  sample.tried.state.assign(result.state.size(), RunState::pending);
  for (; done < std::min(kSamples, places.size()) && seconds_since(start) < 2; ++done) {
    // An odd multiplier visits the samples out of order, so that stopping early leaves a fair choice.
    const std::size_t place =
        places[places.size() < kSamples ? done : (7 * done % kSamples) * places.size() / kSamples];
    const std::size_t run = result.run_at(place);
    try {
      const Trace trace = simulate(sweep.experiment(result.cell_of(run), result.replicate_of(run)), options);
      add_unknown_outcome(sweep.measures(), trace, report.notes);
      sample.tried.notes[place] = note_bits(report.notes), sample.tried.state[place] = RunState::done;
    } catch (const std::exception&) {
      ++sample.failed;  // the sweep would record it
    }
  }
  if (done > 0) sample.seconds_per_run = seconds_since(start) / static_cast<double>(done);
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
  if (sample.seconds_per_run)
    std::printf("\n  about %.3g s on %d threads (%.3g ms a run, some tried)",
                *sample.seconds_per_run * static_cast<double>(runs) / omp_get_max_threads(),
                omp_get_max_threads(), 1e3 * *sample.seconds_per_run);
  else
    std::printf("\n  no time to estimate: no run was tried");
  if (sample.failed > 0) std::printf("; %d of those tried failed", sample.failed);
  std::printf("\n  file: %s\n", work.file_text.c_str());
  for (const std::string& note : note_lines(sample.tried))
    std::printf("  note on the runs that were tried: %s\n", note.c_str());
  print_replaced(request.overrides);
  if (request.strict) refuse_notes(sample.tried);
  return kDone;
}

int dry_run_of_runs(const Sweep& sweep, const SweepPlan& plan, const CommandLine& line,
                    const SweepRequest& request) {
  char text[80];
  std::snprintf(text, sizeof text, "%.3g MB while it runs, less when it is finished",
                1e-6 * static_cast<double>(size_in_progress(plan.result, plan.attributes)));
  return dry_run(sweep,
                 {plan.result.runs_in(RunState::pending).size(), plan.result.runs_in(RunState::done).size(),
                  text, plan.result},
                 line, request);
}

// Tries the first replicate of cells that are spread over those of the shard.
int dry_run_of_tally(const Sweep& sweep, const Shard& shard, const TallyPlan& plan, const CommandLine& line,
                     const SweepRequest& request) {
  constexpr std::size_t kSamples = 16;
  const SweepResult outline = sweep.outline();
  const std::size_t cells = shard.cells_of(outline.cell_count());
  const std::uint64_t done = plan.tally.held.count(), left = plan.own_runs - done;
  const std::size_t tried = left == 0 ? 0 : std::min(kSamples, cells);
  std::vector<std::uint64_t> runs;
  for (std::size_t i = 0; i < tried; ++i) runs.push_back(outline.run(shard.cell(i * cells / tried), 0));
  const SweepResult sample = sweep.part(runs);
  return dry_run(
      sweep, {left, done, "a tally of " + std::to_string(cells) + (cells == 1 ? " cell" : " cells"), sample},
      line, request);
}

// Does what is left of a session, with progress. Returns false if it was interrupted.
template <class Session>
bool run_session(const CommandLine& line, const SweepRequest& request, const std::string& file,
                 Session& session) {
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

int make_runs(const CommandLine& line, const SweepRequest& request, const std::string& file,
              SweepSession session) {
  if (!run_session(line, request, file, session))
    return print_interrupted(file, session.result().runs_in(RunState::done).size());
  const int code = print_summary(file, session.result());
  if (request.strict) refuse_notes(session.result());
  return code;
}

int make_tally(const CommandLine& line, const SweepRequest& request, const std::string& file,
               TallySession session) {
  if (!run_session(line, request, file, session))
    return print_interrupted(file, session.tally().held.count());
  const int code = print_summary(file, session.tally(), session.digest());
  if (request.strict) refuse_notes(session.tally());
  return code;
}

}  // namespace

int command_sweep(const CommandLine& line, const SweepRequest& request) {
  const auto value_of = [](const char* variable) -> const char* { return std::getenv(variable); };
  const Shard shard =
      request.shard.empty() ? shard_from_environment(value_of).value_or(Shard{}) : parse_shard(request.shard);
  const Sweep sweep = Sweep::load(request.sweep, request.overrides);
  const std::string file = with_shard(request.output, shard);
  if (file.empty() && !request.dry_run)
    throw InputError("--output", "is required; see remote-touch sweep --help");
  if (!file.empty()) require_writable(file);
  const TextAttributes attributes = attributes_of(sweep, request, shard);
  if (sweep.keep() != Keep::runs)
    return request.dry_run
               ? dry_run_of_tally(sweep, shard, tally_plan_in_file(sweep, shard, attributes, file), line,
                                  request)
               : make_tally(line, request, file, TallySession(sweep, shard, attributes, file));
  if (request.dry_run)
    return dry_run_of_runs(sweep, plan_in_file(sweep, shard, attributes, file), line, request);
  return make_runs(line, request, file, SweepSession(sweep, shard, attributes, file));
}

}  // namespace remote_touch
