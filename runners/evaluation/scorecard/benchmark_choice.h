// Chooses the methods and scenes that a scorecard compares: those of a HIP, or those of a tool. A scene for
// tools names the tool. A method is for tools if its renderer has six degrees of freedom.
#pragma once

#include <string>
#include <vector>

#include "runners/evaluation/scorecard/benchmark_run.h"

namespace remote_touch {

bool is_for_tools(const Method& method);
inline bool is_for_tools(const BenchmarkScene& scene) {
  return !scene.tool.empty();
}

// Returns the methods and scenes with these names or from these JSON files. No names of one kind: all of
// data/ that fit the others; no names at all: all for a HIP. Throws InputError as chosen_methods() does, and
// for a scene that does not fit.
Benchmark chosen_benchmark(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                           int replicates, const std::string& folder);

}  // namespace remote_touch
