#include <algorithm>
#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/cli/commands.h"
#include "runners/cli/outputs.h"
#include "runners/cli/progress.h"
#include "runners/regression/baselines/baseline_bless.h"
#include "runners/regression/baselines/baseline_check.h"
#include "runners/regression/comparison/comparison_report.h"
#include "runners/regression/comparison/comparison_text.h"

namespace remote_touch {

namespace {

using State = BaselineCheck::State;

const char* word_for(State state) {
  switch (state) {
    case State::same:
      return "same";
    case State::changed:
      return "CHANGED";
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
      throw InputError("baseline " + name, "there is none in " + request.folder + "/manifest.json");
    list.push_back(*baseline);
  }
  return request.names.empty() ? manifest.baselines : list;
}

void print(const BaselineCheck& check) {
  std::printf("%-18s %-24s %s\n", word_for(check.state), check.name.c_str(), check.text.c_str());
  if (check.comparison && check.state != State::same) print_comparison(*check.comparison);
}

ReportSuite suite_of(const std::vector<BaselineCheck>& checks) {
  ReportSuite suite{"baselines"};
  for (const BaselineCheck& check : checks) {
    using Case = ReportCase::State;
    const Case state = check.state == State::same      ? Case::passed
                       : check.state == State::changed ? Case::failed
                       : check.state == State::not_run ? Case::skipped
                                                       : Case::error;
    suite.cases.push_back({check.name, state, check.text});
  }
  return suite;
}

// What was compared; what was not has a verdict and no columns.
std::vector<ResultComparison> comparisons(const std::vector<BaselineCheck>& checks) {
  std::vector<ResultComparison> list;
  for (const BaselineCheck& check : checks) {
    if (check.comparison)
      list.push_back(*check.comparison);
    else
      list.push_back({check.name, "this program", check.state == State::not_run ? "not run" : "none"});
    list.back().baseline = check.name;
    if (check.state == State::changed) list.back().outcome = Outcome::regressed;
    if (!check.comparison) list.back().verdict = check.text;
  }
  return list;
}

int exit_code(const std::vector<BaselineCheck>& checks) {
  const auto any = [&](State state) {
    return std::any_of(checks.begin(), checks.end(), [&](const auto& check) { return check.state == state; });
  };
  if (!any(State::same) && !any(State::changed)) return kBadInput;  // nothing was compared
  return any(State::not_comparable) ? kBadInput : any(State::changed) ? kCheckFailed : kDone;
}

}  // namespace

int command_baseline_check(const CommandLine& line, const BaselineCheckRequest& request) {
  const Manifest manifest = read_manifest(request.folder);
  if (!request.json.empty()) require_report(line, request.json, {}, kJsonReports);
  if (!request.junit.empty()) require_report(line, request.junit, {}, kJunitReport);
  const std::vector<Baseline> list = chosen(manifest, request);
  std::vector<BaselineCheck> checks;
  Progress progress("baselines", line.quiet);
  for (const Baseline& baseline : list) {
    progress.update(checks.size(), list.size(), 0, "baselines");
    checks.push_back(check_baseline(request.folder, baseline, *line.kernels, line.stop));
    print(checks.back());
  }
  if (request.names.empty())
    for (BaselineCheck& missing : missing_baselines(request.folder, manifest)) {
      print(missing);
      checks.push_back(std::move(missing));
    }
  if (checks.empty()) throw InputError(request.folder, "holds no baselines: expected a folder with some");
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
  return kDone;
}

}  // namespace remote_touch
