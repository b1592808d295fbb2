// The commands that compare and check: `compare`, `hashes` and `verify`.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/result_file.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"

namespace remote_touch {
namespace {

struct CompareRequest {
  std::string baseline, candidate;
  std::vector<std::string> tolerances;  // "force=1e-9,1e-6"
  bool paired = false;
  double margin = 0.02, shift_margin = 0.1, alpha = 0.01;
  std::string json, junit, plot, view;  // files to write; empty: none
};

struct VerifyRequest {
  std::vector<std::string> renderers;  // empty: all
  std::vector<std::string> overrides;  // "r1_m=0.004"
  std::string junit;
};

// "force=1e-9", or "force=1e-9,1e-6": absolute, relative.
void add_tolerance(const std::string& text, Tolerances& tolerances) {
  const auto refuse = [&] {
    throw InputError(
        "--tolerance " + text,
        "expected COLUMN=ABSOLUTE or COLUMN=ABSOLUTE,RELATIVE with numbers of 0 or more; * is every column");
  };
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) refuse();
  Tolerance tolerance;
  const char *next = text.data() + equals + 1, *end = text.data() + text.size();
  for (double* part : {&tolerance.absolute, &tolerance.relative}) {
    const auto [stop, error] = std::from_chars(next, end, *part);
    if (error != std::errc() || !(*part >= 0) || std::isinf(*part)) refuse();
    next = stop;
    if (next == end) break;
    if (*next++ != ',' || part == &tolerance.relative) refuse();
  }
  if (next != end) refuse();
  tolerances[text.substr(0, equals)] = tolerance;
}

Recipe recipe(const CompareRequest& request) {
  Recipe recipe{"compare", request.baseline};
  recipe.candidate = request.candidate, recipe.tolerances = request.tolerances;
  return recipe;
}

void require_traces_to_draw(const CompareRequest& request, const ResultComparison& comparison) {
  if (comparison.kind == "trace" || (request.plot.empty() && request.view.empty())) return;
  throw InputError(request.plot.empty() ? "--view " + request.view : "--plot " + request.plot,
                   "the results are of kind " + comparison.kind + ": expected two traces");
}

void write_plot(const CommandLine& line, const CompareRequest& request, const ResultComparison& comparison) {
  const StoredTrace baseline(request.baseline), candidate(request.candidate);
  const Json config = {{"baseline_digest", attribute(baseline.attributes(), "digest")},
                       {"candidate_digest", attribute(candidate.attributes(), "digest")}};
  write_figure(request.plot, deviation_figure(baseline, candidate, *comparison.columns),
               provenance(config.dump(), recipe(request), line.kernels->isa));
}

int command_compare(const CommandLine& line, const CompareRequest& request) {
  require_distinct({{"--json", request.json},
                    {"--junit", request.junit},
                    {"--plot", request.plot},
                    {"--view", request.view}});
  ComparisonRules rules;
  for (const std::string& text : request.tolerances) add_tolerance(text, rules.tolerances);
  rules.paired = request.paired;
  rules.rule = {request.margin, request.shift_margin, request.alpha};
  const std::vector<std::string> inputs{request.baseline, request.candidate};
  if (!request.json.empty()) require_report(line, request.json, inputs, kJsonReport);
  if (!request.junit.empty()) require_report(line, request.junit, inputs, kJunitReport);
  const ViewRequest view{inputs, {}, request.view};
  if (!request.view.empty()) require_report(line, request.view, inputs, kPage);
  std::optional<FileLock> lock;
  if (!request.plot.empty()) lock.emplace(lock_output(line, request.plot, inputs));
  const ResultComparison comparison = compare_results(request.baseline, request.candidate, rules);
  require_traces_to_draw(request, comparison);
  const Report report = report_of(comparison);
  std::fputs(report.text().c_str(), stdout);
  if (!request.json.empty()) write_file_atomically(request.json, report.json());
  if (!request.junit.empty())
    write_file_atomically(request.junit, junit({{request.baseline, report.cases()}}));
  if (!request.plot.empty()) write_plot(line, request, comparison);
  if (!request.view.empty()) write_view(line, view);
  return static_cast<int>(comparison.outcome);
}

std::string text(const CheckResult& result) {
  std::string all = result.scene + ", tick " + std::to_string(result.comparison.first_violation) + ":";
  for (const Deviation& d : result.comparison.deviations)
    if (!(d.max <= d.tolerance))
      all += formatted(" %s %.3g %s (allowed %.3g)", d.quantity, d.max, d.unit, d.tolerance);
  return all + (result.remark.empty() ? "" : "; " + result.remark);
}

// Prints one line for a check over all scenes. Below it prints the worst deviation of each quantity that has
// a tolerance or deviates.
void print_check(const CheckName& check, const std::vector<CheckResult>& results) {
  int scenes = 0, failed = 0, ticks = 0;
  std::map<std::string, Deviation> worst;
  std::string reason;
  for (const CheckResult& result : results) {
    if (result.check != check.name) continue;
    ++scenes, failed += result.passed() ? 0 : 1, ticks += result.comparison.ticks;
    reason = result.reason;
    for (const Deviation& d : result.comparison.deviations) {
      const auto [place, is_new] = worst.try_emplace(d.quantity, d);
      if (!is_new && d.max > place->second.max) place->second = d;
    }
  }
  std::printf("  %-4s %-18s %d scene(s), %4d ticks  %s\n", failed > 0 ? "FAIL" : "pass", check.name, scenes,
              ticks, check.meaning);
  std::erase_if(worst, [](const auto& one) { return one.second.tolerance == 0 && one.second.max == 0; });
  if (!worst.empty()) std::printf("       tolerance: %s\n", reason.c_str());
  for (const auto& [quantity, d] : worst)
    std::printf("       %-20s at most %.3g %s, allowed %.3g\n", quantity.c_str(), d.max, d.unit, d.tolerance);
  for (const CheckResult& result : results)
    if (result.check == check.name && !result.passed()) std::printf("       in %s\n", text(result).c_str());
}

ReportSuite suite_of(const std::string& renderer, const std::vector<CheckResult>& results) {
  ReportSuite suite{"verify " + renderer};
  for (const CheckResult& result : results)
    suite.cases.push_back({result.check + " in " + result.scene,
                           result.passed() ? ReportCase::State::passed : ReportCase::State::failed,
                           result.passed() ? "" : text(result)});
  return suite;
}

int command_verify(const CommandLine& line, const VerifyRequest& request) {
  std::vector<std::string> inputs;  // tool_mesh=FILE and the like; other values are no files
  for (const std::string& assignment : request.overrides)
    inputs.push_back(assignment.substr(assignment.find('=') + 1));
  if (!request.junit.empty()) require_report(line, request.junit, inputs, kJunitReport);
  refuse_discarded(request.overrides);
  std::vector<const RendererEntry*> chosen;
  for (const std::string& name : request.renderers)
    chosen.push_back(&find_entry(renderers(), name, "renderer"));
  if (chosen.empty())
    for (const RendererEntry& entry : renderers()) chosen.push_back(&entry);
  std::vector<ReportSuite> suites;
  bool all_pass = true;
  for (const RendererEntry* entry : chosen) {
    const auto results = verify_renderer(*entry, request.overrides, *line.kernels, line.stop);
    std::printf("%s: %zu checks\n", entry->name.c_str(), results.size());
    for (const CheckName& check : check_names(entry->degrees_of_freedom)) print_check(check, results);
    for (const CheckResult& result : results) all_pass &= result.passed();
    suites.push_back(suite_of(entry->name, results));
  }
  if (!request.junit.empty()) write_file_atomically(request.junit, junit(suites));
  print_replaced(request.overrides);
  return all_pass ? kDone : kCheckFailed;
}

constexpr const char* kExitCodesOfCompare = R"(Exit code:
  0  same: every number is equal, or within its tolerance; with --paired also within the margins
  1  REGRESSED: a measure got worse, or runs of a sweep failed that had not
  2  they cannot be compared; with --paired also: too few runs to decide
  4  CHANGED: different, and no measure is shown to be worse; improvements belong here, and results without
     a direction, such as figures and hashes)";

}  // namespace

int command_hashes(const CommandLine& line, const HashesRequest& request) {
  require_every(request.every);
  const FileLock lock = lock_output(line, request.output, {request.trace});
  const StoredTrace trace(request.trace);
  const TickHashes hashes = hashes_of_trace(trace, request.every);
  write_hashes(request.output, hashes, provenance_of(trace.attributes()));
  const std::string last = hashes.tick.empty() ? "" : formatted(", the last of tick %d", hashes.tick.back());
  std::printf("%s: %zu hashes%s\n", printable(request.output).c_str(), hashes.tick.size(), last.c_str());
  return kDone;
}

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
}

void add_hashes(Subcommands& commands) {
  auto [hash, hashes] = commands.add(
      "hashes", "extract the running hash of a trace, to find the first tick that differs on another machine",
      command_hashes, kNoThreads);
  hash->add_option("trace", hashes->trace, "a trace")->required();
  hash->add_option("--every", hashes->every, "keep only every n-th tick");
  hash->add_option("-o,--output", hashes->output, "the HDF5 file to write")->required();
}

void add_verify(Subcommands& commands) {
  auto [other, verify] = commands.add(
      "verify", "metamorphic checks: relations that must hold when a scene is transformed", command_verify);
  other->add_option("renderers", verify->renderers,
                    "names of 3-DOF renderers from `remote-touch list` (default: all)");
  add_set(other, verify->overrides, "parameter=value of the renderer, for example r1_m=0.004");
  other->add_option("--junit", verify->junit, "also write a report in JUnit's XML format");
}

}  // namespace remote_touch
