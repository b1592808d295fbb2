// Chooses the methods and scenes that a scorecard compares: those of a HIP, those of a tool, or those of
// teleoperation. A scene for tools names the tool; a scene of teleoperation has a slave. A method is for
// tools if its renderer has six degrees of freedom, and for teleoperation if it has sections of the
// experiment.
#pragma once

#include <string>
#include <vector>

#include "runners/evaluation/scorecard/benchmark_run.h"

namespace remote_touch {

enum class Compared { hip, tools, teleoperation };
Compared compared(const Method& method);
Compared compared(const BenchmarkScene& scene);

// Returns the methods and scenes with these names or from these JSON files. No names of one kind: all of
// data/ that fit the others; no names at all: all for a HIP. Throws InputError as chosen_methods() does, and
// for a scene that does not fit.
Benchmark chosen_benchmark(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                           int replicates, const std::string& folder);

}  // namespace remote_touch
