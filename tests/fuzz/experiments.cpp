// Experiments and their origin.
#include <sstream>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::experiments {
namespace {

// Experiments as JSON, and the option --set: each line is one key=value, applied to a whole experiment. An
// accepted experiment is written complete, and comes back the same.

const char* const kExperiment = R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints"}, "fixtures": [{"name": "half-space"}, {"name": "everywhere"}]})";

Experiment survives(const Experiment& experiment) {
  const std::string complete = experiment.to_json();
  Experiment again = Experiment::from_json(complete, "complete experiment");
  require(again.to_json() == complete, "an experiment survives writing and reading");
  return again;
}

void read_experiment(std::string_view bytes) {
  accepts(bytes, [&] {
    const Experiment again = survives(Experiment::from_json(std::string(bytes), "experiment"));
    again.inputs(), again.max_stiffness_N_per_m();
  });
}

void read_settings(std::string_view bytes) {
  std::istringstream lines{std::string(bytes)};
  std::vector<std::string> settings;
  for (std::string line; std::getline(lines, line);) settings.push_back(line);
  accepts(bytes, [&] { survives(Experiment::from_json(kExperiment, "experiment", settings)); });
}

const Registered of_experiment("experiment", read_experiment);
const Registered of_settings("setting", read_settings);

// Reads the origin that a result states: recipe, hashes of inputs, configuration. The input is two texts,
// separated by a line "---".

void read_origin(std::string_view bytes) {
  const auto [first, second] = two_parts(bytes);
  const std::string a(first), b(second);
  if (const auto recipe = recipe_of({{kRecipe, a}})) {
    command_text(*recipe);
    require(recipe_of({{kRecipe, to_json(*recipe)}}).has_value(), "a recipe survives writing and reading");
  }
  require(changed_inputs(a, b).empty() == changed_inputs(b, a).empty(), "a difference is one both ways");
  require(changed_inputs(a, a).empty(), "a text does not differ from itself");
  accepts(bytes, [&] { require(configuration_differences(a, a).empty(), "a configuration is its own"); });
  accepts(bytes, [&] { configuration_differences(a, b); });
}

const Registered of_origin("provenance", read_origin);

}  // namespace
}  // namespace remote_touch::fuzz::experiments
