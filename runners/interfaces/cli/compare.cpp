// The commands that compare and check: `compare`, `hashes` and `verify`.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/comparison/compared_columns.h"
#include "analysis/comparison/trace_comparison.h"
#include "analysis/figures/result_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/comparison_report.h"
#include "runners/evaluation/regression/junit_report.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/progress.h"

namespace remote_touch {
namespace {

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
  if (comparison.kind == "trace") return;
  if (!request.plot.empty())
    throw InputError("--plot " + request.plot,
                     "the results are of kind " + comparison.kind + ": expected two traces");
  if (!request.view.empty())
    throw InputError("--view " + request.view,
                     "the results are of kind " + comparison.kind + ": expected two traces");
}

void write_plot(const CommandLine& line, const CompareRequest& request, const ResultComparison& comparison) {
  const StoredTrace baseline(request.baseline), candidate(request.candidate);
  const Json config = {{"baseline_digest", attribute(baseline.attributes(), "digest")},
                       {"candidate_digest", attribute(candidate.attributes(), "digest")}};
  write_figure(request.plot, deviation_figure(baseline, candidate, *comparison.columns),
               provenance(config.dump(), recipe(request), line.kernels->isa));
}

}  // namespace

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
  print_comparison(comparison);
  if (!request.json.empty()) write_report(request.json, comparison_json(comparison));
  if (!request.junit.empty()) write_report(request.junit, junit({suite_of(comparison, request.baseline)}));
  if (!request.plot.empty()) write_plot(line, request, comparison);
  if (!request.view.empty()) write_view(line, view);
  return static_cast<int>(comparison.outcome);
}

int command_hashes(const CommandLine& line, const HashesRequest& request) {
  if (request.every < 1) throw InputError("--every " + std::to_string(request.every), "expected 1 or more");
  const FileLock lock = lock_output(line, request.output, {request.trace});
  const StoredTrace trace(request.trace);
  const TickHashes hashes = hashes_of_trace(trace, request.every);
  write_hashes(request.output, hashes, provenance_of(present_attributes(trace.attributes())));
  std::printf("%s: %zu hashes", printable(request.output).c_str(), hashes.tick.size());
  if (!hashes.tick.empty()) std::printf(", the last of tick %d", hashes.tick.back());
  std::printf("\n");
  return kDone;
}

namespace {

std::string text(const CheckResult& result) {
  std::string all = result.scene + ", tick " + std::to_string(result.comparison.first_violation) + ":";
  for (const Deviation& d : result.comparison.deviations) {
    if (d.max <= d.tolerance) continue;
    char part[128];
    std::snprintf(part, sizeof part, " %s %.3g %s (allowed %.3g)", d.quantity, d.max, d.unit, d.tolerance);
    all += part;
  }
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
  bool explained = false;
  for (const auto& [quantity, d] : worst) {
    if (d.tolerance == 0 && d.max == 0) continue;
    if (!explained) std::printf("       tolerance: %s\n", reason.c_str());
    explained = true;
    std::printf("       %-20s at most %.3g %s, allowed %.3g\n", quantity.c_str(), d.max, d.unit, d.tolerance);
  }
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

}  // namespace

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
  if (!request.junit.empty()) write_report(request.junit, junit(suites));
  print_replaced(request.overrides);
  return all_pass ? kDone : kCheckFailed;
}

}  // namespace remote_touch
