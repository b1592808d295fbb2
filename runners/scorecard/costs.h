// What renderers cost: wall clock of ticks and frames on this machine. Not the same twice, so kept apart from
// all results.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runners/scorecard/benchmark_run.h"

namespace remote_touch {

struct Cost {
  std::string scene, method;
  double tick_s = 0;   // mean of a tick
  double frame_s = 0;  // mean of taking a frame; NaN without any
};

// One run on one thread, at the noise level of 0.6 r_c where there are levels: the faster of two. Frames come
// with every point made, so neither ticks nor frames contain the making of noise. NaN where the run ends with
// an error. Throws Interrupted.
Cost measured_cost(const BenchmarkSweep& sweep, const std::string& scene, const std::string& method,
                   const Kernels& kernels, const std::atomic<bool>* stop);

// A JSON file beside the results, so that the page of a finished scorecard stays as it is. origin: of this
// program, and where it ran; costs of another are not read. Empty for a file that is not there or is none.
void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs,
                 const TextAttributes& origin);
std::vector<Cost> read_costs(const std::filesystem::path& file, const TextAttributes& origin);
// Build, instruction set and processor.
TextAttributes cost_origin(const Kernels& kernels);
const Cost* find_cost(const std::vector<Cost>& costs, const std::string& scene, const std::string& method);

}  // namespace remote_touch
