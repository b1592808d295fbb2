#include "runners/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <sstream>

#include "analysis/storage/sha256.h"
#include "core/parameters/input_error.h"
#include "runners/cli/other_kinds.h"
#include "runners/experiment/catalog.h"
#include "runners/export/export_formats.h"
#include "runners/plugins/plugin_library.h"
#include "runners/provenance/provenance.h"
#include "runners/schedule/enough_threads.h"

namespace remote_touch {

namespace {

// That a command starts; 0: as OpenMP decides, less: none.
template <class Request>
int threads_of(const std::string& command, const Request& request) {
  if constexpr (requires { request.threads; }) return request.threads;
  for (const char* idle :
       {"list", "describe", "inspect", "merge", "hashes", "devices", "cache", "jitter", "summary"})
    if (command == idle) return -1;
  return 0;
}

// One subcommand with its options. act is called when it was asked for, and there are threads for it; what
// the options fill lives as long as it does.
struct Subcommands {
  CLI::App& app;
  CommandLine& line;
  std::function<int()>& act;
  int& threads;

  template <class Request>
  std::pair<CLI::App*, Request*> add(const char* name, const char* meaning,
                                     int (*run)(const CommandLine&, const Request&)) {
    auto request = std::make_shared<Request>();
    CLI::App* command = app.add_subcommand(name, meaning);
    command->callback([&act = act, &line = line, &threads = threads, request, run, command] {
      if (!command->get_subcommands().empty()) return;  // that one was asked for
      threads = threads_of(command->get_name(), *request);
      act = [&line, request, run] { return run(line, *request); };
    });
    return {command, request.get()};
  }
};

// As CLI::Range, which lets NaN through.
std::string not_between(double low, double high, const std::string& text) {
  double value = 0;
  if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
  std::ostringstream problem;
  problem << "Value " << text << " not in range [" << low << " - " << high << "]";
  return problem.str();
}
CLI::Validator between(double low, double high) {
  return {[=](const std::string& text) { return not_between(low, high, text); }, "NUMBER"};
}

void add_set(CLI::App* command, std::vector<std::string>& overrides, const char* meaning) {
  command->add_option("--set", overrides, meaning)->allow_extra_args(false);
}

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
  commands.add("list",
               "list the names of scenarios, renderers, trajectories, experiments, sweeps, figures, measures",
               command_list);
  auto [describe, described] = commands.add(
      "describe",
      "describe the parameters of a name: range, default, meaning; `trace`: the columns of a trace",
      command_describe);
  describe->add_option("name", described->name, "a name from `remote-touch list`, or trace")->required();
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
  inspect->add_option("file", inspected->file, "an HDF5 file")->required();
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
}

void add_merge_and_replay(Subcommands& commands) {
  auto [command, merge] =
      commands.add("merge", "merge the shards (parts) of a sweep into one file", command_merge);
  command->add_option("shards", merge->shards, "the files of all shards")->required();
  command->add_option("-o,--output", merge->output, "the HDF5 file to write")->required();

  auto [again, replay] =
      commands.add("replay", "run one cell of a sweep again and store its trace", command_replay);
  again->add_option("map", replay->map, "the result of a sweep")->required();
  again
      ->add_option(
          "--cell", replay->cell,
          "index on each axis, from 0, for example 3,40; or a value of each, for example noise_sigma_m=0.003,rule=none")
      ->required();
  again->add_option("--replicate", replay->replicate, "number of the replicate, from 0");
  again->add_option("-o,--output", replay->output, "the HDF5 file to write")->required();
}

void add_figure(Subcommands& commands) {
  auto [command, figure] = commands.add(
      "figure", "reproduce figures and check their claims; writes HDF5 files and claims.json", make_figures);
  command->add_option("names", figure->names, "names from `remote-touch list`, or all")->required();
  command->add_option("-o,--output", figure->folder, "the folder to write into")->required();
  command
      ->add_option("--coarse", figure->coarse,
                   "maps: use only every Nth value of each axis; claims about a whole map then stay open")
      ->check(CLI::Range(1, 10));
  command->add_flag("--quick", figure->quick,
                    "--coarse only for the two maps that take minutes, 4.13-replicated and 4.13-tracked");
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
      below.add("store", "store the numbers of a scorecard for check", command_scorecard_store);
  add_scorecard_options(store_command, *store, "all");
  add_seeds(store_command, *store);
  store_command->add_option("--stored", store->file, "the file to write")->capture_default_str();
  auto [summary_command, summary] =
      below.add("summary", "print what the stored scorecard says, as Markdown", command_scorecard_summary);
  summary_command->add_option("--stored", summary->file, "the stored scorecard")->capture_default_str();
}

constexpr const char* kExitCodesOfCompare = R"(Exit code:
  0  same: every number is equal, or within its tolerance; with --paired also within the margins
  1  REGRESSED: a measure got worse, or runs of a sweep failed that had not
  2  they cannot be compared; with --paired also: too few runs to decide
  4  CHANGED: different, and no measure is shown to be worse: an improvement, too, and whatever has no
     direction, as figures and hashes)";

void add_compare(Subcommands& commands) {
  auto [command, compare] = commands.add("compare", "compare two results", command_compare);
  command->footer(kExitCodesOfCompare);
  command->add_option("baseline", compare->baseline, "a trace, sweep, figure or file of hashes")->required();
  command->add_option("candidate", compare->candidate, "another file of the same kind")->required();
  command
      ->add_option(
          "--tolerance", compare->tolerances,
          "NAME=ABSOLUTE[,RELATIVE] of a column or a measure; * stands for all; default: exactly equal")
      ->allow_extra_args(false);
  command->add_flag("--paired", compare->paired,
                    "compare sweeps by paired tests over regions; single runs may differ");
  command
      ->add_option("--margin", compare->margin, "maximum change of a fraction of runs that counts as equal")
      ->check(between(0, 1))
      ->capture_default_str();
  command
      ->add_option(
          "--shift-margin", compare->shift_margin,
          "the same for measures that are not events: runs that increased minus runs that decreased, and change of the mean")
      ->check(between(0, 1))
      ->capture_default_str();
  command
      ->add_option("--alpha", compare->alpha,
                   "significance level: probability of reporting better, worse or changed where nothing is")
      ->check(between(0, 1))
      ->capture_default_str();
  command->add_option("--json", compare->json, "also write the complete report to this JSON file");
  command->add_option(
      "--junit", compare->junit,
      "also write a report in JUnit's XML format: worse is a failure, other differences are skipped with a message, what "
      "is not comparable or undecided is an error");
  command->add_option("--plot", compare->plot,
                      "also write a figure of the deviation over time (HDF5, for scripts/plot)");
  command->add_option("--view", compare->view, "also write a page that shows both traces in 3-D (HTML)");

  auto [hash, hashes] = commands.add(
      "hashes", "extract the running hash of a trace, to find the first tick that differs on another machine",
      command_hashes);
  hash->add_option("trace", hashes->trace, "a trace")->required();
  hash->add_option("--every", hashes->every, "keep only every n-th tick");
  hash->add_option("-o,--output", hashes->output, "the HDF5 file to write")->required();
}

void add_baseline(Subcommands& commands) {
  CLI::App* parent = commands.app.add_subcommand(
      "baseline", "check or store baselines: stored results that later versions are compared with");
  parent->require_subcommand(1);
  Subcommands below{*parent, commands.line, commands.act, commands.threads};
  auto [command, check] = below.add(
      "check",
      "compute every stored result again and compare; exit code 0: all the same, 1: some changed (better or "
      "worse), 2: some could not be compared",
      command_baseline_check);
  command->add_option("names", check->names, "names of baselines (default: all; none may be missing)");
  command->add_option("--folder", check->folder, "folder of the baselines")->capture_default_str();
  command->add_option("--json", check->json, "also write the complete report to this JSON file");
  command->add_option("--junit", check->junit, "also write a report in JUnit's XML format");

  auto [other, bless] =
      below.add("bless", "store a result as a baseline, with its spread over builds", command_baseline_bless);
  other->add_option("names", bless->names, "names of baselines, or all")->required();
  other->add_option("--reason", bless->reason, "why the new numbers are correct");
  other->add_option("--run", bless->run,
                    "for a new baseline: its experiment, a name or a JSON file in the folder");
  other->add_option("--sweep", bless->sweep, "for a new baseline: its sweep");
  add_set(other, bless->overrides, "for a new baseline: parameter=value");
  other->add_option("--other-build", bless->also, "a build of the same source by another compiler")
      ->allow_extra_args(false);
  other->add_flag("--one-compiler", bless->one_compiler, "measure the spread with this compiler only");
  other->add_option("--folder", bless->folder, "folder of the baselines")->capture_default_str();
}

void add_repro_and_verify(Subcommands& commands) {
  auto [command, repro] = commands.add(
      "repro", "print the command that reproduces a result; with --run, run it and compare", command_repro);
  command->add_option("file", repro->file, "a trace, sweep or figure")->required();
  command->add_flag(
      "--run", repro->run,
      "run it again from the stored configuration and compare; exit code 0: the same, 1: different, 2: not "
      "comparable");
  command->add_option("--config", repro->config, "write the stored configuration to this JSON file");

  auto [other, verify] = commands.add(
      "verify", "metamorphic checks: relations that must hold when a scene is transformed", command_verify);
  other->add_option("renderers", verify->renderers,
                    "names of 3-DOF renderers from `remote-touch list` (default: all)");
  add_set(other, verify->overrides, "parameter=value of the renderer, for example r1_m=0.004");
  other->add_option("--junit", verify->junit, "also write a report in JUnit's XML format");
}

void add_live(Subcommands& commands) {
  auto [command, live] = commands.add(
      "live", "run an experiment in real time, with a depth sensor and a haptic device", command_live);
  command
      ->add_option("experiment", live->experiment,
                   "a name from `remote-touch list`, a JSON file, or a recorded live session")
      ->required();
  add_set(command, live->overrides, "parameter=value, for example safety.max_force_N=3");
  command->add_option(
      "--device", live->device,
      "haptic device, SCHEME:ADDRESS; see remote-touch devices (default: sim:, with --view browser:)");
  CLI::Option* const view =
      command->add_flag("--view", live->view, "show the run in a browser, where the mouse moves the hand");
  command->add_option("--view-port", live->view_port, "its port on 127.0.0.1; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->needs(view)
      ->capture_default_str();
  command->add_option("--depth", live->depth, "depth sensor, SCHEME:ADDRESS; see remote-touch devices")
      ->capture_default_str();
  command->add_option("--duration", live->duration_s, "duration in seconds (default: until SIGINT)")
      ->check(between(1e-3, 1e6));
  command->add_option("--record", live->record, "record device and sensor to this HDF5 file");
  command->add_option("-o,--output", live->output, "the HDF5 file for the trace");
  command->add_option(
      "--report", live->report,
      "write timing and counts to this HDF5 file (a figure for scripts/plot); also on SIGUSR1");
  commands.add("devices", "list sensors, haptic devices and OpenCL devices: what was found, or why not",
               command_devices);
  auto [other, jitter] =
      commands.add("jitter", "measure the timing of the haptic loop on this machine", command_jitter);
  other->add_option("--duration", jitter->duration_s, "duration in seconds")
      ->check(between(0.01, 86400.0))
      ->capture_default_str();
  other->add_option("--rate", jitter->rate_hz, "ticks per second")
      ->check(between(1.0, 100000.0))
      ->capture_default_str();
}

void add_cache(Subcommands& commands) {
  auto [command, cache] = commands.add(
      "cache",
      "show folder and size of the cache of tools and measured times, and the instruction set in use",
      command_cache);
  command
      ->add_option("--max", cache->max_MB,
                   "remove what was used longest ago until at most so many MB are left; 0: everything")
      ->check(between(0, 1e9));
}

// Their renderers join the catalog; results name them.
void take_plugins(const std::vector<std::string>& files) {
  if (files.empty()) return;
  Catalog catalog = catalog_in_use();
  ProgramIdentity program = program_identity();
  for (const std::string& file : files) {
    for (RendererEntry& entry : load_plugin(file)) catalog.add(std::move(entry));
    program.plugins.push_back({file, sha256_of_file(file)});
  }
  use_catalog(std::move(catalog));
  identify_program(std::move(program));
}

// An unknown command is named, which CLI11 leaves to guess.
InputError usage_error(CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> left = app.remaining(true);
  CLI::App* place = &app;
  while (!place->get_subcommands().empty()) place = place->get_subcommands().front();
  if (place->get_subcommands(nullptr).empty() || left.empty())
    return InputError(error.what(), "see remote-touch --help");
  std::string known;
  for (const CLI::App* command : place->get_subcommands(nullptr))
    known += (known.empty() ? "" : ", ") + command->get_name();
  return InputError(left.front(), "unknown: expected " + known);
}

}  // namespace

int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)()) {
  CLI::App app{"Haptic rendering of streaming point clouds: simulate, evaluate, reproduce figures."};
  app.require_subcommand(1);
  app.set_version_flag("--version", "remote-touch " + version());
  app.fallthrough();
  app.add_flag("-q,--quiet", line.quiet, "do not show progress");
  app.add_flag(
      "--force", line.force,
      "also overwrite files that are not results of this program; an input file is never overwritten");
  app.add_option("--plugin", line.plugins,
                 "a shared library with renderers, one for each --plugin; see runners/plugins/README.md")
      ->allow_extra_args(false)
      ->type_name("FILE");
  std::function<int()> act;
  int threads = -1;
  Subcommands commands{app, line, act, threads};
  for (const auto add : {add_lists, add_run, add_sweep, add_merge_and_replay, add_figure, add_scorecard,
                         add_compare, add_baseline, add_repro_and_verify, add_live, add_cache})
    add(commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    throw usage_error(app, error);
  }
  if (threads >= 0) use_threads(threads);
  line.kernels = &choose_kernels();
  take_plugins(line.plugins);
  return act();
}

}  // namespace remote_touch
