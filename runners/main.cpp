// remote-touch: the command line.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "core/input_error.h"
#include "runners/commands/commands.h"
#include "runners/provenance.h"
#include "runners/simulation.h"

namespace {

using namespace remote_touch;

std::atomic<bool> stop_requested{false};

void request_stop(int) {
  stop_requested = true;
}

// REMOTE_TOUCH_ISA lowers the instruction set of the kernels, to check that results do not depend on it.
const Kernels& chosen_kernels() {
  const char* wanted = std::getenv("REMOTE_TOUCH_ISA");
  const Isa best = best_isa();
  if (wanted == nullptr) return kernels_for(best);
  for (const Isa isa : {Isa::x86_64, Isa::x86_64_v3, Isa::x86_64_v4})
    if (isa <= best && kernels_for(isa).isa == std::string(wanted)) return kernels_for(isa);
  throw InputError(std::string("REMOTE_TOUCH_ISA = ") + wanted,
                   std::string("allowed x86-64 up to ") + kernels_for(best).isa + " on this machine");
}

// An unknown command is named, which CLI11 leaves to guess.
InputError usage_error(CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> left = app.remaining();
  if (!app.get_subcommands().empty() || left.empty())
    return InputError(error.what(), "see remote-touch --help");
  std::string known;
  for (const CLI::App* command : app.get_subcommands(nullptr))
    known += (known.empty() ? "" : ", ") + command->get_name();
  return InputError(left.front(), "unknown; allowed " + known);
}

int run_command_line(int argc, char** argv) {
  CLI::App app{"Haptic rendering of streaming point clouds: simulate, evaluate, reproduce figures."};
  app.require_subcommand(1);
  app.set_version_flag("--version", "remote-touch " + version());
  app.fallthrough();
  CommandLine line;
  line.stop = &stop_requested;
  app.add_flag("-q,--quiet", line.quiet, "no progress");

  app.add_subcommand("list", "scenarios, renderers, trajectories, experiments, sweeps, figures, measures");
  std::string name;
  auto* describe = app.add_subcommand("describe", "every parameter: range, default, meaning");
  describe->add_option("name", name, "a scenario, renderer, trajectory, experiment or figure")->required();

  RunRequest run;
  auto* run_command = app.add_subcommand("run", "run one experiment and store its trace");
  run_command->add_option("experiment", run.experiment, "a name of the list, or a JSON file")->required();
  run_command->add_option("--set", run.overrides, "parameter=value, for example renderer.r1_m=0.004")
      ->allow_extra_args(false);
  run_command->add_option("-o,--output", run.output, "the HDF5 file to write")->required();
  run_command->add_flag("--timing", run.timing, "also store the wall clock of each tick");

  FigureRequest figure;
  auto* figure_command = app.add_subcommand("figure", "reproduce figures: HDF5 and claims.json");
  figure_command->add_option("names", figure.names, "figures of the list, or all")->required();
  figure_command->add_option("-o,--output", figure.folder, "the folder to write into")->required();

  SweepRequest sweep;
  auto* sweep_command =
      app.add_subcommand("sweep", "run an experiment over a grid of parameters; resumes by itself");
  sweep_command->add_option("sweep", sweep.sweep, "a name of the list, or a JSON file")->required();
  sweep_command->add_option("--set", sweep.overrides, "parameter=value of the experiment, or of the sweep")
      ->allow_extra_args(false);
  auto* sweep_output = sweep_command->add_option(
      "-o,--output", sweep.output, "the HDF5 file to write or to go on with; {shard} stands for the shard");
  sweep_command->add_option("--threads", sweep.threads, "how many threads (default: OMP_NUM_THREADS, or all)")
      ->check(CLI::Range(1, 4096));
  sweep_command->add_option("--shard", sweep.shard,
                            "i/N: only part i of N (default: as Slurm or mpirun say, else all of it)");
  auto* dry_run = sweep_command->add_flag("--dry-run", sweep.dry_run,
                                          "check every cell, estimate time and file size, write nothing");

  MergeRequest merge;
  auto* merge_command = app.add_subcommand("merge", "put the shards of a sweep together");
  merge_command->add_option("shards", merge.shards, "the files of all shards")->required();
  merge_command->add_option("-o,--output", merge.output, "the HDF5 file to write")->required();

  ReplayRequest replay;
  auto* replay_command = app.add_subcommand("replay", "run one cell of a sweep again and store its trace");
  replay_command->add_option("map", replay.map, "the result of a sweep")->required();
  replay_command->add_option("--cell", replay.cell, "place on each axis, counted from 0, for example 3,40")
      ->required();
  replay_command->add_option("--replicate", replay.replicate, "counted from 0");
  replay_command->add_option("-o,--output", replay.output, "the HDF5 file to write")->required();

  std::string file;
  app.add_subcommand("inspect", "what is in a result file")
      ->add_option("file", file, "an HDF5 file")
      ->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw usage_error(app, error);
  }
  if (sweep_command->parsed() && sweep_output->empty() && dry_run->empty())
    throw InputError("--output", "is required; see remote-touch sweep --help");
  line.kernels = &chosen_kernels();
  const std::string chosen = app.get_subcommands().front()->get_name();
  if (chosen == "list") return command_list();
  if (chosen == "describe") return command_describe(name);
  if (chosen == "run") return command_run(line, run);
  if (chosen == "sweep") return command_sweep(line, sweep);
  if (chosen == "merge") return command_merge(merge);
  if (chosen == "replay") return command_replay(line, replay);
  if (chosen == "figure") return command_figure(line, figure);
  return command_inspect(file);
}

// One line, whatever the user's names contain.
void complain(std::string problem) {
  std::replace(problem.begin(), problem.end(), '\n', ' ');
  std::fprintf(stderr, "remote-touch: %s\n", problem.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  // Sweeps build and drop scenes by the thousand: memory given back to the system each time costs a tenth.
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  try {
    const int code = run_command_line(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
      throw InputError("standard output", "cannot be written; allowed a place with room");
    return code;
  } catch (const Interrupted&) {
    complain("interrupted; nothing half-written was left behind");
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return kBadInput;
}
