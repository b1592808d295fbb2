#include "runners/interfaces/cli/experiment_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/parameters/input_error.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/embedded_data.h"
#include "runners/interfaces/cli/subcommands.h"
#include "runners/presentation/export/export_formats.h"
#include "runners/sweep/threads/work_pool.h"

namespace remote_touch {
namespace {

template <class Entries>
bool has(const Entries& entries, const std::string& name) {
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return name == entry.name; });
}

bool is_of(const std::string& command, const std::string& name) {
  if (command == "run") return has(embedded_experiments(), name);
  if (command == "sweep") return has(embedded_sweeps(), name);
  return has(figures(), name);
}

std::string advice(const char* kind, const std::string& command, const std::string& name,
                   const char* output) {
  return std::string("is ") + kind + ": expected `remote-touch " + command + " " + name + " -o " + output +
         "`";
}

}  // namespace

std::string other_kind(const std::string& name, const std::string& command) {
  std::error_code unreachable;
  if (is_of(command, name) || std::filesystem::exists(name, unreachable)) return {};
  if (is_of("run", name)) return advice("an experiment", "run", name, "FILE");
  if (is_of("sweep", name)) return advice("a sweep", "sweep", name, "FILE");
  // The name of a figure is its number. Experiments and sweeps are named like their files: fig4.12.
  for (const std::string& number : {name, name.starts_with("fig") ? name.substr(3) : std::string()})
    if (is_of("figure", number)) return advice("a figure", "figure", number, "FOLDER");
  return {};
}

namespace {

// The options of the commands that list names, run experiments and show results.

void require_own_kind(const std::string& name, const char* command) {
  if (const std::string other = other_kind(name, command); !other.empty()) throw InputError(name, other);
}
int run_experiment(const CommandLine& line, const RunRequest& request) {
  require_own_kind(request.experiment, "run");
  return command_run(line, request);
}
int run_sweep(const CommandLine& line, const SweepRequest& request) {
  require_own_kind(request.sweep, "sweep");
  return command_sweep(line, request);
}
int make_figures(const CommandLine& line, const FigureRequest& request) {
  for (const std::string& name : request.names) require_own_kind(name, "figure");
  return command_figure(line, request);
}

void add_lists(Subcommands& commands) {
  auto [list, listed] = commands.add(
      "list",
      "list the names of scenarios, renderers, trajectories, experiments, sweeps, tools, figures, measures",
      command_list);
  list->add_option("kind", listed->kind, "list only this kind, for example renderers (default: all)");
  auto [describe, described] = commands.add(
      "describe",
      "describe the parameters of a name: range, default, meaning; `trace`: the columns of a trace",
      command_describe);
  describe
      ->add_option("name", described->name,
                   "a name from `remote-touch list`, or trace; or one parameter: proxy.r1_m, trace.force")
      ->required();
  auto [view, viewed] = commands.add(
      "view", "make a page that shows a trace, two of them, or a sweep, in 3-D and over time", command_view);
  view->add_option("results", viewed->results, "a trace, two traces to compare, or a sweep")
      ->required()
      ->expected(1, 2);
  view->add_option("-o,--output", viewed->output, "the HTML page to write")->required();
  view->add_option("--cells", viewed->cells,
                   "cells of a sweep to show, 3,4 or noise_sigma_m=0.003,..., one for each --cells "
                   "(default: failures nearest to the limit)")
      ->allow_extra_args(false);
  view->add_option("--max-mb", viewed->max_MB, "largest size of the page, MB; points are left out for it")
      ->check(between(1.0, 1000.0));
  view->add_option(
      "--claims", viewed->claims,
      "claims.json of `remote-touch figure`: the page of a figure's run shows the figure's claims");
  auto [exporting, exported] =
      commands.add("export", "write a result in the format of other programs", command_export);
  exporting->add_option("file", exported->file, "a trace, sweep or figure")->required();
  exporting
      ->add_option("output", exported->output,
                   "the file to write; its ending is the format: " + known_formats())
      ->required();
  auto [inspect, inspected] = commands.add("inspect", "show what a result file contains", command_inspect);
  inspect->add_option("file", inspected->file, "an HDF5 file, or a folder with the shards of a sweep")
      ->required();
}

void add_run(Subcommands& commands) {
  auto [command, run] = commands.add("run", "run one experiment and store its trace", run_experiment);
  command
      ->add_option("experiment", run->experiment,
                   "a name from `remote-touch list`, a JSON file, or a recorded live session")
      ->required();
  add_set(command, run->overrides, "parameter=value, for example renderer.r1_m=0.004");
  command->add_option("-o,--output", run->output, "the HDF5 file to write")->required();
  command->add_flag("--timing", run->timing, "also store the duration of each tick");
  command->add_flag("--all", run->all, "print all measures, not only those that matter most for this run");
  command->add_flag("--strict", run->strict,
                    "a note on the run is an error: exit code 2, and nothing is written");
}

void add_sweep(Subcommands& commands) {
  auto [command, sweep] = commands.add(
      "sweep", "run an experiment over a grid of parameters; the same command resumes it", run_sweep);
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

void add_merge_replay_and_recheck(Subcommands& commands) {
  auto [command, merge] =
      commands.add("merge", "merge the shards (parts) of a sweep into one file", command_merge);
  command->add_option("shards", merge->shards, "the files of all shards")->required();
  command->add_option("-o,--output", merge->output, "the HDF5 file to write")->required();
  command->add_flag("--partial", merge->partial,
                    "shards may be missing or unfinished; the file states which shards it has");

  auto [again, replay] =
      commands.add("replay", "run one cell of a sweep again and store its trace", command_replay);
  again->add_option("sweep", replay->sweep, "the result of a sweep; `run` replays a live session")
      ->required();
  again
      ->add_option(
          "--cell", replay->cell,
          "index on each axis, from 0, for example 3,40; or a value of each, for example noise_sigma_m=0.003,rule=none")
      ->required();
  again->add_option("--replicate", replay->replicate, "number of the replicate, from 0");
  again->add_option("-o,--output", replay->output, "the HDF5 file to write")->required();
  again->add_flag("--strict", replay->strict,
                  "a note on the run is an error: exit code 2, and nothing is written");

  auto [check, recheck] = commands.add(
      "recheck",
      "make one run in a thousand of a sweep again (of a tally all runs of one cell in a thousand, and of at "
      "least one), and compare the bits",
      command_recheck);
  check->add_option("sweeps", recheck->sweeps, "results of sweeps, or their shards")->required();
}

void add_analyse(Subcommands& commands) {
  auto [command, analyse] =
      commands.add("analyse", "answer questions about a sweep: limits, means, differences", command_analyse);
  command->add_option("sweep", analyse->sweep, "the result of a sweep")->required();
  const auto add_list = [&command = command](const char* option, std::vector<std::string>& list,
                                             const char* meaning) {
    command->add_option(option, list, meaning)->delimiter(',')->allow_extra_args(false);
  };
  command->add_option(
      "--limit", analyse->limit,
      "measure of an event (default: popped_through, tool_popped_through or slave_touched): where does its probability cross --level?");
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

std::vector<std::string> figures_thinned_by_quick() {
  std::vector<std::string> names;
  for (const FigureEntry& entry : figures())
    if (entry.quick_coarse > 1) names.emplace_back(entry.name);
  return names;
}

void add_figure(Subcommands& commands) {
  auto [command, figure] = commands.add(
      "figure", "reproduce figures and check their claims; writes HDF5 files and claims.json", make_figures);
  command->add_option("names", figure->names, "names from `remote-touch list`, or all")->required();
  command->add_option("-o,--output", figure->folder, "the folder to write into")->required();
  add_set(
      command, figure->overrides,
      "scenario.path=DIR: for camera-error, a recording with true objects; also other settings of the scenario");
  command
      ->add_option("--coarse", figure->coarse,
                   "maps: use only every Nth value of each axis; claims about a whole map then stay open")
      ->check(CLI::Range(1, 10));
  command->add_flag("--quick", figure->quick,
                    "use only every second to fourth value of each axis of the maps that take minutes: " +
                        joined(figures_thinned_by_quick(), ", "));
}

}  // namespace

void add_commands_of_experiments(Subcommands& commands) {
  add_lists(commands);
  add_run(commands);
  add_sweep(commands);
  add_merge_replay_and_recheck(commands);
  add_analyse(commands);
  add_figure(commands);
}

void print_replaced(const std::vector<std::string>& overrides) {
  for (const std::string& line : replaced_settings(overrides))
    std::fprintf(stderr, "%s: %s\n", program_identity().name.c_str(), printable(line).c_str());
}

}  // namespace remote_touch
