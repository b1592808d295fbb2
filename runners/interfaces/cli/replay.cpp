// The commands that make runs again and compare them: `replay` and `recheck`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/interfaces/cli/repro.h"
#include "runners/presentation/result_pages.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_run.h"
#include "runners/sweep/sweep_session.h"

namespace remote_touch {
namespace {

struct ReplayRequest {
  std::string sweep;
  std::string cell;  // "3,4"
  int replicate = 0;
  std::string output;
  bool strict = false;
  bool all = false;
};

struct RecheckRequest {
  std::vector<std::string> sweeps;  // finished sweeps, or shards
};

// Prints each measure beside the stored one. Returns true if they agree bit for bit, or nothing is stored.
bool agrees(const Sweep& sweep, const KeptSweep& kept, std::size_t run, const Trace& trace) {
  const auto* const result = std::get_if<SweepResult>(&kept.kept);
  const std::size_t place = result ? result->place_of(run).value_or(result->state.size()) : 0;
  const bool stored = result && place < result->state.size() && result->state[place] == RunState::done;
  bool same = true;
  for (std::size_t i = 0; i < sweep.measures().size(); ++i) {
    const Column& measure = kept.grid().measures[i];
    const double now = value_of(sweep.measures()[i], trace);
    const double then = stored ? std::get<std::vector<double>>(result->measures[i].values)[place] : 0;
    const bool equal = std::bit_cast<std::uint64_t>(now) == std::bit_cast<std::uint64_t>(then);
    same &= equal || !stored;
    std::printf("  %-20s %12.6g %-6s %s", measure.name.c_str(), now, measure.units.c_str(),
                stored ? equal ? "as stored\n" : "" : "not stored\n");
    if (stored && !equal) std::printf("stored %.17g, now %.17g\n", then, now);
  }
  return same;
}

// Prints possible reasons for different values: the commit that made the sweep, and the recordings of this
// run that have changed since.
void print_origin(const KeptSweep& stored, const Sweep& sweep, const Experiment& experiment) {
  std::printf("  the sweep was made by git_commit %s\n", attribute(stored.attributes, "git_commit").c_str());
  std::vector<InputPart> parts;  // all parts that the sweep reads, because one hash covers them
  for (const InputPart& part : sweep.inputs())
    for (const InputPart& mine : experiment.inputs())
      if (part.path == mine.path) parts.push_back(part);
  for (const auto& input : changed_inputs(attribute(stored.attributes, "input_digests"), input_hashes(parts)))
    if (input.now != "absent")
      std::printf("  from %s: %s; now %s\n", input.path.c_str(), input.before.c_str(), input.now.c_str());
}

Sweep sweep_of(const TextAttributes& attributes, const std::string& file) {
  return read_configuration(
      attributes, file, [&] { return Sweep::from_json(attribute(attributes, "config"), file + " config"); });
}

// Throws InputError if a recording is missing or has changed since the runs read it: they would differ.
void require_same_recordings(const std::string& file, const Sweep& sweep, const TextAttributes& attributes) {
  for (const ChangedInput& input :
       changed_inputs(attribute(attributes, "input_digests"), input_hashes(sweep.inputs())))
    throw InputError(file, "has runs on the recording " + input.path + " (" + input.before + "; now " +
                               input.now + "): expected the same recording");
}

Recheck recheck_of(const KeptSweep& stored, const std::string& file, const RecheckOptions& options) {
  const Sweep sweep = sweep_of(stored.attributes, file);
  require_same_recordings(file, sweep, stored.attributes);
  return std::visit([&](const auto& kept) { return recheck(kept, sweep, options); }, stored.kept);
}

// Prints the build that made the file, if it is another one: a reason for different bits.
void print_other_build(const TextAttributes& attributes) {
  for (const auto& [name, ours] : build_of(provenance("", "", "")))
    if (const std::string theirs = attribute(attributes, name); theirs != ours)
      std::printf("  made by another build: its %s is %s, here it is %s\n", name.c_str(),
                  printable(theirs).c_str(), printable(ours).c_str());
}

// Returns " (all runs of 1 of 3 cells)" for a tally, which does not keep single runs; else empty.
std::string extent_of(const Recheck& check) {
  if (check.cells_in == 0) return "";
  return " (all runs of " + std::to_string(check.cells) + " of " + std::to_string(check.cells_in) + " cells)";
}

void print_distrust(const TextAttributes& attributes) {
  if (const std::string distrust = distrust_of(attributes); !distrust.empty())
    std::printf("  note: %s\n", printable(distrust).c_str());
}

int replay_one(const CommandLine& line, const ReplayRequest& request) {
  for (const auto& [option, value] : {std::pair("--cell", request.cell), {"--output", request.output}})
    if (value.empty())
      throw InputError(std::string(option) + " is required", "see remote-touch replay --help");
  const FileLock lock = lock_output(line, request.output, {request.sweep});
  const KeptSweep stored = read_kept_sweep(request.sweep, Extent::as_stored);
  const Sweep sweep = sweep_of(stored.attributes, request.sweep);
  const SweepGrid& grid = stored.grid();
  sweep.require_fits(grid, request.sweep);
  const std::size_t cell = cell_of({"--cell", request.cell}, grid);
  if (request.replicate < 0 || request.replicate >= grid.replicates)
    throw InputError("--replicate " + std::to_string(request.replicate),
                     "expected 0 to " + std::to_string(grid.replicates - 1));

  Progress progress("replay", line.quiet);
  SimulationOptions options;
  options.kernels = line.kernels;
  options.stop = line.stop;
  options.progress = [&](double fraction) { progress.update(fraction); };
  const std::size_t run = grid.run(cell, request.replicate);
  const Replay replay = replay_run(stored.attributes, sweep, run, options, request.output,
                                   request.strict ? Strict::yes : Strict::no);
  std::printf("%s: %zu ticks, digest %s\n", printable(request.output).c_str(), replay.trace.length(),
              replay.digest.c_str());
  std::fputs(text_of(replay.report).c_str(), stdout);
  print_distrust(stored.attributes);
  if (agrees(sweep, stored, run, replay.trace)) return kDone;
  print_origin(stored, sweep, replay.experiment);
  return kCheckFailed;
}

int command_recheck(const CommandLine& line, const RecheckRequest& request) {
  int code = kDone;
  for (const std::string& file : request.sweeps) {
    Progress progress("recheck " + file, line.quiet);
    const KeptSweep stored = read_kept_sweep(file, Extent::as_stored);
    const auto show = [&](std::size_t done, std::size_t total) { progress.update(done, total, 0, "runs"); };
    const Recheck check = recheck_of(stored, file, {line.kernels, line.stop, show});
    progress.clear();
    std::printf("%s: %zu run%s made again%s, ", printable(file).c_str(), check.made,
                check.made == 1 ? "" : "s", extent_of(check).c_str());
    if (check.different.empty()) std::puts(check.made == 0 ? "because none is stored" : "all as stored");
    if (!check.different.empty()) {
      std::printf("%zu different\n", check.different.size()), code = kCheckFailed;
      for (const std::string& text : check.different) std::printf("  %s\n", text.c_str());
      print_other_build(stored.attributes);
    }
    print_distrust(stored.attributes);
  }
  return code;
}

// --- replay --all ---

struct ReplayedRuns {
  std::size_t made = 0, different = 0, different_cells = 0;  // runs; cells of tallies
  std::size_t refused = 0, others = 0;                       // files
};

void print_replayed(const std::string& what, const std::string& difference) {
  std::printf("%s: %s%s\n", printable(what).c_str(),
              difference.empty() ? "as stored" : "DIFFERS: ", printable(difference).c_str());
  std::fflush(stdout);  // the next run may take minutes
}

void replay_sweep(const CommandLine& line, const std::string& file, ReplayedRuns& replayed) {
  Progress progress("replay " + file, line.quiet);
  const KeptSweep stored = read_kept_sweep(file, Extent::as_stored);
  const bool is_tally = std::holds_alternative<SweepTally>(stored.kept);
  const auto show = [&](std::size_t done, std::size_t total) { progress.update(done, total, 0, "runs"); };
  const auto print = [&](std::uint64_t number, const std::string& difference) {
    progress.clear();
    print_replayed(
        file + " " +
            (is_tally ? "--cell " + cell_text(stored.grid(), number) : option_of_run(stored.grid(), number)),
        difference);
  };
  const Recheck check = recheck_of(stored, file, {line.kernels, line.stop, show, true, print});
  replayed.made += check.made;
  (is_tally ? replayed.different_cells : replayed.different) += check.different.size();
  progress.clear();
  if (!check.different.empty()) print_other_build(stored.attributes);
  print_distrust(stored.attributes);
}

void replay_trace(const CommandLine& line, const std::string& file, ReplayedRuns& replayed) {
  experiment_of_run(Hdf5Reader(file).attributes(), file);  // refuses a recording that has changed
  const ResultComparison comparison = made_again(line, file);
  const bool is_same = comparison.outcome == Outcome::same;
  ++replayed.made, replayed.different += is_same ? 0 : 1;
  print_replayed(file, is_same ? "" : comparison.verdict);
}

// "trace", "sweep" or "tally"; empty for a file that has no runs that can be made again.
std::string replayed_kind(const std::string& file) {
  const TextAttributes attributes = Hdf5Reader(file).attributes();
  if (is_of_live_run(attributes)) return {};
  for (const char* kind : {"trace", "sweep", "tally"})
    if (attribute(attributes, "schema").starts_with(std::string("remote-touch-") + kind + "/")) return kind;
  return {};
}

void replay_file(const CommandLine& line, const std::string& file, const std::string& kind,
                 ReplayedRuns& replayed) {
  (kind == "trace" ? replay_trace : replay_sweep)(line, file, replayed);
}

// A file that begins as results do, or has the name of one, also if it is damaged.
bool may_be_result(const std::filesystem::directory_entry& entry) {
  std::string opening(kResultOpening.size(), ' ');
  if (std::error_code unreachable; entry.is_regular_file(unreachable))
    std::ifstream(entry.path(), std::ios::binary)
        .read(opening.data(), static_cast<std::streamsize>(opening.size()));
  return opening == kResultOpening || entry.path().extension() == ".h5";
}

// Replays the results in a folder. A file that cannot be replayed does not stop the others.
void replay_folder(const CommandLine& line, const std::string& folder, ReplayedRuns& replayed) {
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (may_be_result(entry)) files.push_back(entry.path().string());
  if (failed) throw InputError(folder, "cannot be read (" + failed.message() + ")");
  std::sort(files.begin(), files.end());
  for (const std::string& file : files) try {
      const std::string kind = replayed_kind(file);
      if (kind.empty())
        ++replayed.others;
      else
        replay_file(line, file, kind, replayed);
    } catch (const InputError& error) {
      ++replayed.refused;
      std::printf("COULD NOT REPLAY %s\n", printable(error.what()).c_str());
    }
  if (replayed.others == files.size())
    throw InputError(folder, "has no traces and no sweeps: expected a folder of results");
}

void print_summary(const ReplayedRuns& replayed) {
  const auto counted = [](std::size_t count, const char* thing) {
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
  };
  std::string text = counted(replayed.made, "run") + " made again";
  if (replayed.different > 0) text += ": " + std::to_string(replayed.different) + " different";
  if (replayed.different_cells > 0) text += ": " + counted(replayed.different_cells, "cell") + " different";
  if (replayed.made > 0 && replayed.different + replayed.different_cells == 0) text += ": all as stored";
  if (replayed.refused > 0) text += "; " + counted(replayed.refused, "file") + " could not be replayed";
  if (replayed.others > 0) text += "; " + counted(replayed.others, "file") + " of other kinds left out";
  std::puts(text.c_str());
}

int replay_all(const CommandLine& line, const std::string& what) {
  ReplayedRuns replayed;
  if (std::error_code unreachable; std::filesystem::is_directory(what, unreachable)) {
    replay_folder(line, what, replayed);
  } else {
    const std::string kind = replayed_kind(what);
    if (kind.empty())
      throw InputError(what, "cannot be replayed: expected a trace of run or replay, a sweep or a tally");
    replay_file(line, what, kind, replayed);
  }
  print_summary(replayed);
  if (replayed.different + replayed.different_cells > 0) return kCheckFailed;
  return replayed.refused > 0 ? kBadInput : kDone;
}

int command_replay(const CommandLine& line, const ReplayRequest& request) {
  return request.all ? replay_all(line, request.sweep) : replay_one(line, request);
}

}  // namespace

void add_replay(Subcommands& commands) {
  auto [again, replay] = commands.add(
      "replay", "run one cell of a sweep again and store its trace; with --all, check every run of a result",
      command_replay);
  again
      ->add_option("sweep", replay->sweep,
                   "the result of a sweep, with --all also a trace or a folder; `run` replays a live session")
      ->required();
  CLI::Option* const all = again->add_flag(
      "--all", replay->all,
      "make every run again and compare it with the stored one, bit for bit: of a sweep, of a trace, or of all "
      "results in a folder; a line for each run, of a tally for each cell");
  all->excludes(again->add_option("--cell", replay->cell,
                                  "index on each axis, from 0, for example 3,40; or a value of each, for "
                                  "example noise_sigma_m=0.003,rule=none"));
  all->excludes(again->add_option("--replicate", replay->replicate, "number of the replicate, from 0"));
  all->excludes(again->add_option("-o,--output", replay->output, "the HDF5 file to write"));
  all->excludes(again->add_flag("--strict", replay->strict,
                                "a note on the run is an error: exit code 2, and nothing is written"));
}

void add_recheck(Subcommands& commands) {
  auto [check, recheck] = commands.add(
      "recheck",
      "make one run in a thousand of a sweep again (of a tally all runs of one cell in a thousand, and of at "
      "least one), and compare the bits",
      command_recheck);
  check->add_option("sweeps", recheck->sweeps, "results of sweeps, or their shards")->required();
}

}  // namespace remote_touch
