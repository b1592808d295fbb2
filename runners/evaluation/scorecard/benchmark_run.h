// Makes the runs of a scorecard: a sweep for each scene and method, each in its own file. A later call
// continues with the runs that an earlier one did not finish.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/benchmark.h"

namespace remote_touch {

// A sweep of the folder, FOLDER/runs/NAME.h5.
struct BenchmarkSweep {
  std::string name;  // SCENE.METHOD
  Sweep sweep;
  TextAttributes attributes;  // provenance
  std::filesystem::path file;
};

struct Benchmark {
  std::vector<Method> methods;
  std::vector<BenchmarkScene> scenes;
  int replicates = 10;
  std::filesystem::path folder;
};

// The sweeps of all methods in a scene, in order. Throws MissingRecording for a scene whose recording is not
// on this machine, InputError for a sweep that cannot be run.
std::vector<BenchmarkSweep> sweeps_of(const Benchmark& benchmark, const BenchmarkScene& scene);

// Throws InputError, before anything is run or written, if a file of one of these sweeps exists that is of
// other settings or another build.
void require_same_benchmark(const std::vector<BenchmarkSweep>& sweeps);

// Does the runs that are left of each sweep. progress: number of sweeps done, of all sweeps, and the fraction
// done of the present one. Throws Interrupted; finished runs are then in the files.
using BenchmarkProgress =
    std::function<void(std::size_t sweeps_done, std::size_t sweeps, double fraction_of_next)>;
void do_sweeps(const std::vector<BenchmarkSweep>& sweeps, const Kernels& kernels,
               const std::atomic<bool>* stop, const BenchmarkProgress& progress);

}  // namespace remote_touch
