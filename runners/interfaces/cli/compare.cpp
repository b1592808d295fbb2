// The commands that compare and check: `compare`, `hashes`, `baseline` and `verify`.
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
#include "runners/evaluation/regression/baselines.h"
#include "runners/evaluation/regression/comparison_report.h"
#include "runners/evaluation/regression/junit_report.h"
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

using State = BaselineCheck::State;

const char* word_for(State state) {
  switch (state) {
    case State::same:
      return "same";
    case State::changed:
      return "CHANGED";
    case State::missing:
      return "MISSING";
    case State::not_run:
      return "not run";
    case State::not_comparable:
      break;
  }
  return "COULD NOT COMPARE";
}

std::vector<Baseline> chosen(const Manifest& manifest, const BaselineCheckRequest& request) {
  std::vector<Baseline> list;
  for (const std::string& name : request.names) {
    const Baseline* baseline = manifest.find(name);
    if (!baseline)
      throw InputError("baseline " + name, "does not exist in " + request.folder + "/manifest.json");
    list.push_back(*baseline);
  }
  return request.names.empty() ? manifest.baselines : list;
}

// The files that a check reads. No report may replace them.
std::vector<std::string> files_of(const std::string& folder, const std::vector<Baseline>& list) {
  std::vector<std::string> files{manifest_file(folder).string()};
  for (const Baseline& baseline : list) {
    files.push_back(file_of(folder, baseline).string());
    files.push_back(subject_of(folder, baseline));
  }
  return files;
}

void print(const BaselineCheck& check) {
  std::printf("%-18s %-24s %s\n", word_for(check.state), check.name.c_str(), check.text.c_str());
  if (check.comparison && check.state != State::same) print_comparison(*check.comparison);
}

// "66 baselines: 63 same, 1 changed, 1 could not be compared, 1 not run; 0 missing"
void print_summary(const std::vector<BaselineCheck>& checks) {
  const auto count = [&](State state) {
    return std::count_if(checks.begin(), checks.end(),
                         [&](const auto& check) { return check.state == state; });
  };
  const auto missing = count(State::missing);
  std::printf("%td baselines: %td same, %td changed, %td could not be compared, %td not run; %td missing\n",
              static_cast<std::ptrdiff_t>(checks.size()) - missing, count(State::same), count(State::changed),
              count(State::not_comparable), count(State::not_run), missing);
}

ReportSuite suite_of(const std::vector<BaselineCheck>& checks) {
  ReportSuite suite{"baselines"};
  for (const BaselineCheck& check : checks) {
    using Case = ReportCase::State;
    const Case state = check.state == State::same                                       ? Case::passed
                       : check.state == State::changed || check.state == State::missing ? Case::failed
                       : check.state == State::not_run                                  ? Case::skipped
                                                                                        : Case::error;
    suite.cases.push_back({check.name, state, check.text});
  }
  return suite;
}

// Returns the comparison of each check. A check without a comparison gets an entry with its verdict and
// without columns.
std::vector<ResultComparison> comparisons(const std::vector<BaselineCheck>& checks) {
  std::vector<ResultComparison> list;
  for (const BaselineCheck& check : checks) {
    if (check.comparison)
      list.push_back(*check.comparison);
    else
      list.push_back({check.name, "this program", check.state == State::not_run ? "not run" : "none"});
    list.back().baseline = check.name;
    if (check.comparison) continue;
    list.back().verdict = check.text;
    if (check.state == State::missing) list.back().outcome = Outcome::changed;
  }
  return list;
}

int exit_code(const std::vector<BaselineCheck>& checks) {
  const auto any = [&](State state) {
    return std::any_of(checks.begin(), checks.end(), [&](const auto& check) { return check.state == state; });
  };
  const bool any_failed = any(State::changed) || any(State::missing);
  if (!any(State::same) && !any_failed) return kBadInput;  // no baseline was compared
  return any(State::not_comparable) ? kBadInput : any_failed ? kCheckFailed : kDone;
}

}  // namespace

int command_baseline_check(const CommandLine& line, const BaselineCheckRequest& request) {
  require_distinct({{"--json", request.json}, {"--junit", request.junit}});
  const Manifest manifest = read_manifest(request.folder);
  const std::vector<std::string> inputs = files_of(request.folder, manifest.baselines);
  if (!request.json.empty()) require_report(line, request.json, inputs, kJsonReports);
  if (!request.junit.empty()) require_report(line, request.junit, inputs, kJunitReport);
  const std::vector<Baseline> list = chosen(manifest, request);
  std::vector<BaselineCheck> checks;
  NoteCounts notes;
  Progress progress("baselines", line.quiet);
  for (const Baseline& baseline : list) {
    progress.update(checks.size(), list.size(), 0, "baselines");
    checks.push_back(check_baseline(request.folder, baseline, *line.kernels, line.stop, &notes));
    print(checks.back());
  }
  progress.clear();
  std::vector<BaselineCheck> missing;
  if (request.names.empty()) missing = missing_baselines(request.folder, manifest);
  for (const BaselineCheck& check : missing) print(check);
  checks.insert(checks.end(), missing.begin(), missing.end());
  if (checks.empty()) throw InputError(request.folder, "holds no baselines: expected a folder with some");
  for (const std::string& note : notes.lines()) std::printf("note: %s\n", note.c_str());
  print_summary(checks);
  if (!request.json.empty()) write_report(request.json, comparison_json(comparisons(checks)));
  if (!request.junit.empty()) write_report(request.junit, junit({suite_of(checks)}));
  return exit_code(checks);
}

int command_baseline_bless(const CommandLine& line, const BaselineBlessRequest& request) {
  std::vector<std::string> names = request.names;
  const bool all = names == std::vector<std::string>{"all"};
  if ((all || names.size() > 1) && !(request.run.empty() && request.sweep.empty()))
    throw InputError("--run, --sweep", "expected with one name only");
  if (all) {
    names.clear();
    for (const Baseline& baseline : read_manifest(request.folder).baselines) names.push_back(baseline.name);
    if (names.empty()) throw InputError(request.folder, "holds no baselines: expected a folder with some");
  }
  for (const std::string& name : names) {
    const std::string done = bless({request.folder, name, request.reason, request.run, request.sweep,
                                    request.overrides, request.also, request.one_compiler, line.stop});
    std::printf("%s\n", done.c_str());
    std::fflush(stdout);
  }
  print_replaced(request.overrides);
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
