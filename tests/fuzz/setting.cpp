// The option --set: each line is one key=value, applied to a whole experiment.
#include <sstream>

#include "runners/experiment/catalog/experiment.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::setting {
namespace {

const char* const kExperiment = R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints"}, "fixtures": [{"name": "half-space"}, {"name": "everywhere"}]})";

void read(std::string_view bytes) {
  std::istringstream lines{std::string(bytes)};
  std::vector<std::string> settings;
  for (std::string line; std::getline(lines, line);) settings.push_back(line);
  accepts(bytes, [&] {
    const std::string complete = Experiment::from_json(kExperiment, "experiment", settings).to_json();
    require(Experiment::from_json(complete, "complete experiment").to_json() == complete,
            "an experiment survives writing and reading");
  });
}

const Registered registered("setting", read);

}  // namespace
}  // namespace remote_touch::fuzz::setting
