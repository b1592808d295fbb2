#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/comparison/compared_columns.h"
#include "analysis/comparison/trace_comparison.h"
#include "analysis/figures/result_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/comparison_report.h"
#include "runners/evaluation/regression/junit_report.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"

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

}  // namespace remote_touch
