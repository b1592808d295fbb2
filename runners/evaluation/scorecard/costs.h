// The cost of renderers: wall-clock time of ticks and frames on this machine. It varies from run to run, so
// it is stored apart from all results.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runners/evaluation/scorecard/benchmark_run.h"

namespace remote_touch {

struct Cost {
  std::string scene, method;
  double tick_s = 0;   // mean of a tick
  double frame_s = 0;  // mean of on_frame(); NaN without frames
};

inline constexpr std::size_t kCostLevel = 3;  // index in scorecard_noise_m(): 0.6 r_c

// Measures one run twice on one thread, at the noise level kCostLevel if there are levels, and returns the
// faster one. Every point of a frame is computed before the frame is passed to the renderer, so the times do
// not contain the generation of noise. Returns NaN if the run ends with an error. Throws Interrupted.
Cost measured_cost(const BenchmarkSweep& sweep, const std::string& scene, const std::string& method,
                   const Kernels& kernels, const std::atomic<bool>* stop);

// The costs are stored in a JSON file beside the results, so that scorecard.json of a finished scorecard does
// not change. origin: see cost_origin(); costs of another origin are not read, nor are those of runs
// that ended with an error. read_costs() returns none for a file that does not exist or cannot be used.
void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs,
                 const TextAttributes& origin);
std::vector<Cost> read_costs(const std::filesystem::path& file, const TextAttributes& origin);
// Build, instruction set and processor.
TextAttributes cost_origin(const Kernels& kernels);
const Cost* find_cost(const std::vector<Cost>& costs, const std::string& scene, const std::string& method);

}  // namespace remote_touch
