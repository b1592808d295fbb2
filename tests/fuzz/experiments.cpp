// Experiments as JSON, and the option --set: each line is one key=value, applied to a whole experiment. An
// accepted experiment is written complete, and comes back the same.
#include <sstream>

#include "runners/experiment/catalog/experiment.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::experiments {
namespace {

const char* const kExperiment = R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints"}, "fixtures": [{"name": "half-space"}, {"name": "everywhere"}]})";

Experiment survives(const Experiment& experiment) {
  const std::string complete = experiment.to_json();
  Experiment again = Experiment::from_json(complete, "complete experiment");
  require(again.to_json() == complete, "an experiment survives writing and reading");
  return again;
}

void read(std::string_view bytes) {
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

const Registered of_text("experiment", read);
const Registered of_settings("setting", read_settings);

}  // namespace
}  // namespace remote_touch::fuzz::experiments
