// A short run with its report, from its scene and its hand.
#pragma once

#include <algorithm>
#include <string>

#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/note_kinds.h"

namespace remote_touch {

struct ReportedRun {
  RunReport report;
  Trace trace;

  Kinds kinds() const { return kinds_of(report.notes); }
  bool has(const std::string& kind) const { return std::ranges::count(kinds(), kind) > 0; }
};

// rest: more members of the experiment, with commas between them.
inline ReportedRun run_of(const std::string& scenario, const std::string& trajectory,
                          const std::string& rest = R"("duration_s": 0.3)",
                          const std::string& renderer = "proxy") {
  const std::string text = R"({"scenario": )" + scenario + R"(, "renderer": {"name": ")" + renderer +
                           R"("}, "trajectory": )" + trajectory + (rest.empty() ? "" : ", ") + rest + "}";
  ReportedRun run;
  SimulationOptions options;
  options.report = &run.report;
  run.trace = simulate(Experiment::from_json(text, "test"), options);
  return run;
}

}  // namespace remote_touch
