// The parts of a benchmark: methods, which are renderers with settings (data/methods), and scenes, which are
// experiments without a renderer, with noise levels, measures and a rule of success (data/scenes). A method
// of teleoperation also has sections of the experiment: what the hand feels, and what keeps the slave away.
#pragma once

#include <string>
#include <vector>

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

}  // namespace remote_touch
