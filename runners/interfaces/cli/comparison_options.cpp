// The options of the commands that compare methods and results.
#include <CLI/CLI.hpp>

#include "runners/interfaces/cli/subcommands.h"
#include "runners/sweep/threads/work_pool.h"

namespace remote_touch {

namespace {

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
      below.add("store", "store the numbers of a scorecard for `scorecard check`", command_scorecard_store);
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
  4  CHANGED: different, and no measure is shown to be worse; improvements belong here, and results without
     a direction, such as figures and hashes)";

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
      ->add_option(
          "--alpha", compare->alpha,
          "significance level: the greatest probability of a false better, worse or changed, over all tests")
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

void add_repro_cite_and_verify(Subcommands& commands) {
  auto [command, repro] = commands.add(
      "repro", "print the command that reproduces a result; with --run, run it and compare", command_repro);
  command->add_option("file", repro->file, "a trace, sweep or figure")->required();
  command->add_flag(
      "--run", repro->run,
      "run it again from the stored configuration and compare; exit code 0: the same, 1: different, 2: not "
      "comparable");
  command->add_option("--config", repro->config, "write the stored configuration to this JSON file");

  auto [citing, cite] = commands.add(
      "cite", "print BibTeX entries of the dissertation and of this program, or also of a result",
      command_cite);
  citing->add_option(
      "file", cite->file,
      "a trace, sweep, figure, scorecard or recorded live session (default: none, the program)");

  auto [other, verify] = commands.add(
      "verify", "metamorphic checks: relations that must hold when a scene is transformed", command_verify);
  other->add_option("renderers", verify->renderers,
                    "names of 3-DOF renderers from `remote-touch list` (default: all)");
  add_set(other, verify->overrides, "parameter=value of the renderer, for example r1_m=0.004");
  other->add_option("--junit", verify->junit, "also write a report in JUnit's XML format");
}

}  // namespace

void add_commands_of_comparisons(Subcommands& commands) {
  add_scorecard(commands);
  add_compare(commands);
  add_baseline(commands);
  add_repro_cite_and_verify(commands);
}

}  // namespace remote_touch
