// Makes the report of a scorecard from its finished runs.
#pragma once

#include <atomic>
#include <functional>

#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/benchmark_plan.h"
#include "runners/evaluation/scorecard/report.h"

namespace remote_touch {

// The scores of all scenes, with comparisons corrected for each other. pre: do_sweeps() has finished.
Scorecard scores_of(const BenchmarkPlan& plan);

// Reads all runs, scores them, traces typical failures and measures the costs that no earlier call measured.
// progress: number of scenes done, and of all. Throws Interrupted. pre: do_sweeps() has finished.
ScorecardReport evaluate(const BenchmarkPlan& plan, const Kernels& kernels, const std::atomic<bool>* stop,
                         const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace remote_touch
