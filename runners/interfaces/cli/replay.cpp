#include <bit>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/tally/tally_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/progress.h"
#include "runners/sweep/cell_text.h"
#include "runners/sweep/shards/recheck.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_origin.h"
#include "runners/sweep/sweep_replay.h"

namespace remote_touch {

namespace {

// Prints each measure beside the stored one. Returns true if they agree bit for bit, or nothing is stored.
bool agrees(const Sweep& sweep, const SweepResult& result, std::size_t run, const Trace& trace) {
  const std::optional<std::size_t> place = result.place_of(run);
  const bool stored = place && result.state[*place] == RunState::done;
  bool same = true;
  for (std::size_t i = 0; i < result.measures.size(); ++i) {
    const double now = value_of(sweep.measures()[i], trace);
    const double then = stored ? std::get<std::vector<double>>(result.measures[i].values)[*place] : 0;
    const bool equal = std::bit_cast<std::uint64_t>(now) == std::bit_cast<std::uint64_t>(then);
    same &= equal || !stored;
    std::printf("  %-20s %12.6g %-6s %s", result.measures[i].name.c_str(), now,
                result.measures[i].units.c_str(), stored ? equal ? "as stored\n" : "" : "not stored\n");
    if (stored && !equal) std::printf("stored %.17g, now %.17g\n", then, now);
  }
  return same;
}

// Prints possible reasons for different values: the commit that made the sweep, and the recordings of this
// run that have changed since.
void print_origin(const StoredSweep& stored, const Sweep& sweep, const Experiment& experiment) {
  std::printf("  the sweep was made by git_commit %s\n", attribute(stored.attributes, "git_commit").c_str());
  std::vector<RecordingPart> parts;  // all parts that the sweep reads, because one hash covers them
  for (const RecordingPart& part : sweep.inputs())
    for (const RecordingPart& mine : experiment.inputs())
      if (part.path == mine.path) parts.push_back(part);
  for (const auto& input : changed_inputs(attribute(stored.attributes, "input_digests"), input_hashes(parts)))
    if (input.now != "absent")
      std::printf("  from %s: %s; now %s\n", input.path.c_str(), input.before.c_str(), input.now.c_str());
}

Sweep sweep_of(const TextAttributes& attributes, const std::string& file) {
  return read_configuration(attributes, file, [&] {
    return Sweep::from_json(stored_configuration(attribute(attributes, "config")), file + " config");
  });
}

// Throws InputError if a recording is missing or has changed since the runs read it: they would differ.
void require_same_recordings(const std::string& file, const Sweep& sweep, const TextAttributes& attributes) {
  for (const ChangedInput& input :
       changed_inputs(attribute(attributes, "input_digests"), input_hashes(sweep.inputs())))
    throw InputError(file, "has runs on the recording " + input.path + " (" + input.before + "; now " +
                               input.now + "): expected the same recording");
}

Recheck recheck_of(const std::string& file, const RecheckOptions& options, TextAttributes& attributes) {
  if (const Hdf5Reader reader(file); is_tally(reader)) {
    StoredTally stored = read_tally(reader);
    attributes = std::move(stored.attributes);
    const Sweep sweep = sweep_of(attributes, file);
    require_same_recordings(file, sweep, attributes);
    return recheck(stored.tally, sweep, options);
  }
  StoredSweep stored = read_stored_part(file);
  attributes = std::move(stored.attributes);
  const Sweep sweep = sweep_of(attributes, file);
  require_same_recordings(file, sweep, attributes);
  return recheck(stored.result, sweep, options);
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

}  // namespace

int command_replay(const CommandLine& line, const ReplayRequest& request) {
  const FileLock lock = lock_output(line, request.output, {request.sweep});
  const StoredSweep stored = read_runs_or_outline(request.sweep);
  const Sweep sweep = sweep_of(stored.attributes, request.sweep);
  const SweepResult& result = stored.result;
  sweep.require_fits(result, request.sweep);
  const std::size_t cell = cell_of({"--cell", request.cell}, result);
  if (request.replicate < 0 || request.replicate >= result.replicates)
    throw InputError("--replicate " + std::to_string(request.replicate),
                     "expected 0 to " + std::to_string(result.replicates - 1));

  Progress progress("replay", line.quiet);
  SimulationOptions options;
  options.kernels = line.kernels;
  options.stop = line.stop;
  options.progress = [&](double fraction) { progress.update(fraction); };
  const std::size_t run = result.run(cell, request.replicate);
  const Replay replay =
      replay_run(stored, sweep, run, options, request.output, request.strict ? Strict::yes : Strict::no);
  std::printf("%s: %zu ticks, digest %s\n", printable(request.output).c_str(), replay.trace.length(),
              replay.digest.c_str());
  std::fputs(text_of(replay.report).c_str(), stdout);
  print_distrust(stored.attributes);
  if (agrees(sweep, result, run, replay.trace)) return kDone;
  print_origin(stored, sweep, replay.experiment);
  return kCheckFailed;
}

int command_recheck(const CommandLine& line, const RecheckRequest& request) {
  int code = kDone;
  for (const std::string& file : request.sweeps) {
    Progress progress("recheck " + file, line.quiet);
    TextAttributes attributes;
    const auto show = [&](std::size_t done, std::size_t total) { progress.update(done, total, 0, "runs"); };
    const Recheck check = recheck_of(file, {line.kernels, line.stop, show}, attributes);
    progress.clear();
    std::printf("%s: %zu run%s made again%s, ", printable(file).c_str(), check.made,
                check.made == 1 ? "" : "s", extent_of(check).c_str());
    if (check.different.empty()) std::puts(check.made == 0 ? "because none is stored" : "all as stored");
    if (!check.different.empty()) {
      std::printf("%zu different\n", check.different.size()), code = kCheckFailed;
      for (const std::string& text : check.different) std::printf("  %s\n", text.c_str());
      print_other_build(attributes);
    }
    print_distrust(attributes);
  }
  return code;
}

}  // namespace remote_touch
