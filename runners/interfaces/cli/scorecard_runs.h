// Steps that the commands of a scorecard share: doing its runs, and reporting on them.
#pragma once

#include <string>
#include <vector>

#include "runners/evaluation/scorecard/benchmark_run.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "runners/interfaces/cli/commands.h"

namespace remote_touch {

// Does the runs that are left, with a line of progress. Throws Interrupted.
void do_scorecard_runs(const CommandLine& line, const std::vector<BenchmarkSweep>& sweeps);
// Makes a page beside the trace of each failure, and notes it in the report. Throws Interrupted, and
// InputError in a program without the viewer.
void make_failure_pages(const CommandLine& line, const std::string& folder, ScorecardReport& report);
// Prints for each kind of note how many runs have it, and the command that shows the first run. Prints how
// many runs ended with an error, and the first one; they count as no success. Returns kDone, or kCheckFailed
// if runs ended with an error.
int report_runs(const std::vector<BenchmarkSweep>& sweeps);
// Prints that the runs are kept. Returns kInterrupted.
int report_interrupted(const std::string& folder);

}  // namespace remote_touch
