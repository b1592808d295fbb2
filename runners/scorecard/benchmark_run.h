// Doing the runs of a scorecard: a sweep for each scene and method, a file each, which go on where an
// earlier call stopped.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "core/kernels/kernels.h"
#include "runners/scorecard/benchmark.h"

namespace remote_touch {

// A sweep of the folder, FOLDER/runs/NAME.h5.
struct BenchmarkSweep {
  std::string name;  // SCENE.CONTENDER
  Sweep sweep;
  TextAttributes attributes;  // provenance
  std::filesystem::path file;
};

struct Benchmark {
  std::vector<Method> methods;
  std::vector<BenchmarkScene> scenes;
  int replicates = 20;
  std::filesystem::path folder;
};

// Whoever takes part in the scene, in order. Throws MissingRecording for a scene whose recording is not on
// this machine, InputError for what cannot be run.
std::vector<BenchmarkSweep> sweeps_of(const Benchmark& benchmark, const BenchmarkScene& scene);

// Throws InputError, before anything is run or written, where a file of one of these sweeps is there that is
// of other settings or another build.
void require_same_benchmark(const std::vector<BenchmarkSweep>& sweeps);

// Does what is left of each. finished: sweeps done and in all, and runs of the present one. Throws
// Interrupted; what is finished is then in the files.
using BenchmarkProgress =
    std::function<void(std::size_t sweeps_done, std::size_t sweeps, double fraction_of_next)>;
void do_sweeps(const std::vector<BenchmarkSweep>& sweeps, const Kernels& kernels,
               const std::atomic<bool>* stop, const BenchmarkProgress& progress);

}  // namespace remote_touch
