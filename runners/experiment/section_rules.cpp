#include "runners/experiment/section_rules.h"

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// A simulated device has no other buttons than those that the operator's settings press.
bool can_be_pressed(const ExperimentConfiguration& configuration, const SequenceStep& step) {
  if (step.start != StepStart::button && step.done != StepEnd::button) return true;
  const std::string& hand = configuration.trajectory.name;
  if (configuration.live || find_entry(trajectories(), hand, "trajectory.name").has_buttons)
    return true;  // the device has its own
  if (!configuration.operator_settings) return false;
  const std::vector<double>& presses = configuration.operator_settings->presses;
  for (std::size_t i = 1; i < presses.size(); i += 3)
    if (presses[i] == step.button) return true;
  return false;
}

}  // namespace

void check_fixtures(ExperimentConfiguration& configuration) {
  const std::string problem = validate(configuration.fixture_values(), configuration.sequence);
  if (!problem.empty()) throw InputError(problem);
}

void complete_guidance(ExperimentConfiguration& configuration) {
  const bool needed = configuration.has_guidance();
  if (configuration.guidance && !needed)
    throw InputError("guidance", "expected only when a fixture has role = guidance");
  if (needed && !configuration.guidance) configuration.guidance.emplace();
}

void check_sequence(ExperimentConfiguration& configuration) {
  for (std::size_t i = 0; i < configuration.sequence.size(); ++i)
    if (!can_be_pressed(configuration, configuration.sequence[i]))
      throw InputError(
          "sequence." + std::to_string(i) + ".button = " + std::to_string(configuration.sequence[i].button),
          "expected a button of operator.presses (any button in experiments with a section live)");
}

}  // namespace remote_touch
