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

// What the command line can hold. Each add_... describes one subcommand and returns it.
struct Requests {
  std::string name;  // of describe
  RunRequest run;
  SweepRequest sweep;
  MergeRequest merge;
  ReplayRequest replay;
  FigureRequest figure;
  std::string file;  // of inspect
};

void add_run(CLI::App& app, RunRequest& run) {
  auto* command = app.add_subcommand("run", "run one experiment and store its trace");
  command->add_option("experiment", run.experiment, "a name of the list, or a JSON file")->required();
  command->add_option("--set", run.overrides, "parameter=value, for example renderer.r1_m=0.004")
      ->allow_extra_args(false);
  command->add_option("-o,--output", run.output, "the HDF5 file to write")->required();
  command->add_flag("--timing", run.timing, "also store the wall clock of each tick");
}

void add_sweep(CLI::App& app, SweepRequest& sweep) {
  auto* command =
      app.add_subcommand("sweep", "run an experiment over a grid of parameters; resumes by itself");
  command->add_option("sweep", sweep.sweep, "a name of the list, or a JSON file")->required();
  command->add_option("--set", sweep.overrides, "parameter=value of the experiment, or of the sweep")
      ->allow_extra_args(false);
  command->add_option("-o,--output", sweep.output,
                      "the HDF5 file to write or to go on with; {shard} stands for the shard, 2of7");
  command->add_option("--threads", sweep.threads, "how many threads (default: OMP_NUM_THREADS, or all)")
      ->check(CLI::Range(1, 4096));
  command->add_option("--shard", sweep.shard,
                      "i/N: only part i of N (default: as Slurm or mpirun say, else all of it)");
  command->add_flag("--dry-run", sweep.dry_run,
                    "check every cell, estimate time and file size, write nothing");
}

void add_merge_and_replay(CLI::App& app, MergeRequest& merge, ReplayRequest& replay) {
  auto* command = app.add_subcommand("merge", "put the shards of a sweep together");
  command->add_option("shards", merge.shards, "the files of all shards")->required();
  command->add_option("-o,--output", merge.output, "the HDF5 file to write")->required();

  command = app.add_subcommand("replay", "run one cell of a sweep again and store its trace");
  command->add_option("map", replay.map, "the result of a sweep")->required();
  command->add_option("--cell", replay.cell, "place on each axis, counted from 0, for example 3,40")
      ->required();
  command->add_option("--replicate", replay.replicate, "counted from 0");
  command->add_option("-o,--output", replay.output, "the HDF5 file to write")->required();
}

void add_figure(CLI::App& app, FigureRequest& figure) {
  auto* command = app.add_subcommand("figure", "reproduce figures: HDF5 and claims.json");
  command->add_option("names", figure.names, "figures of the list, or all")->required();
  command->add_option("-o,--output", figure.folder, "the folder to write into")->required();
}

int dispatch(const std::string& command, const CommandLine& line, const Requests& requests) {
  if (command == "list") return command_list();
  if (command == "describe") return command_describe(requests.name);
  if (command == "run") return command_run(line, requests.run);
  if (command == "sweep") return command_sweep(line, requests.sweep);
  if (command == "merge") return command_merge(requests.merge);
  if (command == "replay") return command_replay(line, requests.replay);
  if (command == "figure") return command_figure(line, requests.figure);
  return command_inspect(requests.file);
}

int run_command_line(int argc, char** argv) {
  CLI::App app{"Haptic rendering of streaming point clouds: simulate, evaluate, reproduce figures."};
  app.require_subcommand(1);
  app.set_version_flag("--version", "remote-touch " + version());
  app.fallthrough();
  CommandLine line;
  line.stop = &stop_requested;
  app.add_flag("-q,--quiet", line.quiet, "no progress");

  Requests requests;
  app.add_subcommand("list", "scenarios, renderers, trajectories, experiments, sweeps, figures, measures");
  app.add_subcommand("describe", "every parameter: range, default, meaning")
      ->add_option("name", requests.name, "a name of the list")
      ->required();
  add_run(app, requests.run);
  add_sweep(app, requests.sweep);
  add_merge_and_replay(app, requests.merge, requests.replay);
  add_figure(app, requests.figure);
  app.add_subcommand("inspect", "what is in a result file")
      ->add_option("file", requests.file, "an HDF5 file")
      ->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw usage_error(app, error);
  }
  line.kernels = &chosen_kernels();
  return dispatch(app.get_subcommands().front()->get_name(), line, requests);
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
