// The contract of every measure.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/trace/trace.h"
#include "runners/evaluation/contract/checks.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {

namespace {

// Returns four traces: a press, a press of a tool, a run with guidance, and a copy of the first press whose
// distances to the surface are unknown (NaN). The runs are simulated once.
const std::vector<Trace>& traces() {
  static const std::vector<Trace> all = [] {
    std::vector<Trace> made;
    SimulationOptions options;
    options.find_true_contact = true;
    for (const char* experiment : {"fig4.11", "tool-slab", "fixture-tasks"})
      made.push_back(simulate(Experiment::load(experiment, {"duration_s=0.1"}), options));
    Trace unknown = made.front();
    for (double& distance_m : unknown.signed_distance_m) distance_m = std::nan("");
    unknown.slave_distance_m = unknown.signed_distance_m;
    made.push_back(std::move(unknown));
    return made;
  }();
  return all;
}

bool same_value(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void is_described(const Measure& measure, const FillSettings&) {
  EXPECT_GT(measure.meaning.size(), 10u);
  EXPECT_FALSE(measure.unit.empty()) << "expected \"1\" for a number without a unit";
  ASSERT_TRUE(measure.compute);
}

void the_same_trace_has_the_same_value(const Measure& measure, const FillSettings&) {
  for (const Trace& trace : traces()) {
    if (!applies(measure, trace)) continue;
    const double first = measure.compute(trace);
    EXPECT_TRUE(same_value(measure.compute(trace), first));
    EXPECT_FALSE(std::isinf(first)) << "expected NaN where nothing can be said";
  }
}

void a_trace_without_ticks_does_no_harm(const Measure& measure, const FillSettings&) {
  const Trace none;
  EXPECT_FALSE(std::isinf(measure.compute(none)));
}

constexpr ContractCheck<Measure> kMeasureChecks[] = {
    {"IsDescribed", is_described},
    {"TheSameTraceHasTheSameValue", the_same_trace_has_the_same_value},
    {"ATraceWithoutTicksDoesNoHarm", a_trace_without_ticks_does_no_harm},
};

}  // namespace

std::span<const ContractCheck<Measure>> measure_checks() {
  return kMeasureChecks;
}

}  // namespace remote_touch
