// The runs of a scorecard: the choice of methods and scenes, all sweeps, the passivity audit, and doing them.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/benchmark.h"

namespace remote_touch {

// The passivity audit: closed cycles of a simulated hand with every choice of signs in the renderers' force
// laws, to find which of them feed energy into the hand.

// Scenes of the audit. A HIP presses and slides. A tool does the same, and also presses, tilts and turns.
inline constexpr const char* kPassivityScenes[] = {"passivity", "tool-passivity-slide",
                                                   "tool-passivity-turn"};
inline constexpr int kPassivityCycles = 3;  // number of cycles in a run of such a scene

// Returns the method with each combination of those parameters of its renderer that affect energy: without
// and with a damper k_d (4.16), its sign where there is one, and the sign of the velocity term of (4.15) if a
// velocity is estimated. The name is METHOD, then what differs from the method's own: "proxy+v_plus+k_d3".
// The method itself is the first.
std::vector<Method> force_laws_of(const Method& method);

// Makes the runs of a scorecard: a sweep for each scene and method, each in its own file. A later call
// continues with the runs that an earlier one did not finish.

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

// Throws InputError, before anything is run or written, if a file of one of these sweeps exists that is of
// other settings or another build.
void require_same_benchmark(const std::vector<BenchmarkSweep>& sweeps);

// Does the runs that are left of each sweep. progress: number of sweeps done, of all sweeps, and the fraction
// done of the present one. Throws Interrupted; finished runs are then in the files.
using BenchmarkProgress =
    std::function<void(std::size_t sweeps_done, std::size_t sweeps, double fraction_of_next)>;
void do_sweeps(const std::vector<BenchmarkSweep>& sweeps, const Kernels& kernels,
               const std::atomic<bool>* stop, const BenchmarkProgress& progress);

struct ScenePlan {
  BenchmarkScene scene;
  std::vector<BenchmarkSweep> sweeps;  // one for each method
};

// All sweeps of a scorecard: those of its scenes, and those of the passivity audit.
struct BenchmarkPlan {
  Benchmark benchmark;
  std::vector<ScenePlan> scenes;
  // Force laws that the passivity audit compares, and their sweeps in each of its scenes; empty without them.
  std::vector<Method> laws;
  std::vector<ScenePlan> audit;
  // Scenes whose recording is not on this machine, and why.
  std::vector<std::pair<std::string, std::string>> skipped;

  std::vector<BenchmarkSweep> sweeps() const;  // each sweep once
};

// Resolves and checks every run. Throws InputError for what cannot be run.
BenchmarkPlan plan_of(const Benchmark& benchmark);

// A scorecard compares methods and scenes of a HIP, of a tool, or of teleoperation. A scene for tools
// names the tool; a scene of teleoperation has a slave. A method is for tools if its renderer has six degrees
// of freedom, and for teleoperation if it has sections of the experiment.
enum class Compared { hip, tools, teleoperation };
Compared compared(const Method& method);
Compared compared(const BenchmarkScene& scene);

// Returns the methods and scenes with these names or from these JSON files. No names of one kind: all of
// data/ that fit the others; no names at all: all for a HIP. Throws InputError as chosen_methods() does, and
// for a scene that does not fit.
Benchmark chosen_benchmark(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                           int replicates, const std::string& folder);

}  // namespace remote_touch
