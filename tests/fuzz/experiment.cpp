// Experiments as JSON. An accepted experiment is written complete, and comes back the same.
#include "runners/experiment/catalog/experiment.h"

#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::experiment {
namespace {

void read(std::string_view bytes) {
  accepts(bytes, [&] {
    const std::string complete = Experiment::from_json(std::string(bytes), "experiment").to_json();
    const Experiment again = Experiment::from_json(complete, "complete experiment");
    require(again.to_json() == complete, "an experiment survives writing and reading");
    again.inputs(), again.max_stiffness_N_per_m();
  });
}

const Registered registered("experiment", read);

}  // namespace
}  // namespace remote_touch::fuzz::experiment
