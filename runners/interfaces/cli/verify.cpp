#include <cstdio>
#include <map>

#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/comparison_report.h"
#include "runners/evaluation/regression/junit_report.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"

namespace remote_touch {

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
