// A benchmark and its runs. Its parts are methods, which are renderers with settings (data/methods), and
// scenes, which are experiments without a renderer, with noise levels, measures and a rule of success
// (data/scenes). A method of teleoperation also has sections of the experiment: what the hand feels, and what
// keeps the slave away.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/scorecard.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

// r_c of every method's defaults, and the noise levels of the scorecard in metres.
inline constexpr double kScorecardRadius_m = 0.005;
const std::vector<double>& scorecard_noise_m();  // 0, .1, .2, .6, 1 and 2 r_c

// The parameters of the tracked sheet were tuned with seeds 1 to kLastTunedSeed. The runs of a scorecard use
// another seed.
inline constexpr int kLastTunedSeed = 40;
inline constexpr int kScorecardSeed = 431;

struct Method {
  std::string name, title;
  std::string renderer;   // JSON
  std::string file = {};  // the JSON file that it was read from; empty: data/methods or a renderer's defaults
  std::string sections = {};  // JSON: sections of the experiment of a method of teleoperation; empty: none
};

struct BenchmarkScene {
  struct Judged {
    std::string measure;
    Better better;  // neither: only reported
  };
  std::string name, title;
  std::string experiment;        // JSON, without a renderer
  std::string noise;             // path of the parameter; empty: one column with the scene's own noise
  std::vector<Judged> measures;  // measures in addition to those of the bounds
  std::string meaning;           // success in words
  std::vector<Bound> success;
  std::vector<Bound> old_success = {};  // the rule before the symmetric one; empty: there was none
  std::string tool = {};  // JSON: settings of the renderers that define their tool; empty: for a HIP
  std::string file = {};  // the JSON file that it was read from; empty: from data/scenes

  // Returns the sweep of a method. It varies only noise level and replicate, so that cell and replicate, the
  // keys of all noise, are the same for every method. A scene with its own noise has as many runs as others
  // have with noise. Throws InputError if the method cannot be run. If the text of a scene or method file is
  // wrong, the message begins with the name of that file.
  Sweep sweep(const Method& method, int replicates) const;
};

// Methods and scenes as JSON, stored with results.
std::string configuration(const std::vector<Method>& methods, const std::vector<BenchmarkScene>& scenes,
                          int replicates);

// Reads a method or scene from JSON text; errors name it by `name`. Every scene gets the measures in
// perception's units, among them max_relative_jump, which has a published threshold. A scene with the rule
// "held" also gets those of its contact.
Method read_method(const std::string& name, const std::string& json);
BenchmarkScene read_benchmark_scene(const std::string& name, const std::string& json);

// Returns the methods or scenes with these names or from these JSON files, in their order; no names: all of
// data/. A method or scene of a file is named after the file, without folder and ending. Throws InputError
// for a name that is unknown, with those that are allowed, or that appears twice.
std::vector<Method> chosen_methods(const std::vector<std::string>& names);
std::vector<BenchmarkScene> chosen_scenes(const std::vector<std::string>& names);

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
