#include "runners/experiment/catalog/scheduled_phases.h"

#include <string>

#include "runners/experiment/catalog/configuration.h"

namespace remote_touch {

namespace {

// Adds a phase for each pair of successive rows between which the fraction changes. rows: times and
// fractions, see scheduled().
void add_schedule(const std::string& name, const std::vector<double>& rows, std::vector<Phase>& phases) {
  for (std::size_t i = 2; i < rows.size(); i += 2)
    if (rows[i + 1] != rows[i - 1]) phases.push_back({"the change of " + name, rows[i - 2], rows[i]});
}

}  // namespace

std::vector<Phase> setting_phases(const ExperimentConfiguration& configuration) {
  std::vector<Phase> phases;
  for (const RendererChange& change : configuration.changes)
    phases.push_back({"the change of " + change.parameter, change.time_s});
  const std::vector<FixtureValues> fixtures = configuration.fixture_values();
  for (std::size_t i = 0; i < fixtures.size(); ++i)
    add_schedule("the strength of fixtures." + std::to_string(i), fixtures[i].schedule, phases);
  for (std::size_t i = 0; i < configuration.sequence.size(); ++i) {
    const SequenceStep& step = configuration.sequence[i];
    if (step.not_before_s > 0)
      phases.push_back({"sequence." + std::to_string(i) + " (" + name_of(step) + ")", step.not_before_s});
  }
  return phases;
}

std::vector<Phase> operator_phases(const ExperimentConfiguration& configuration) {
  std::vector<Phase> phases;
  if (!configuration.operator_settings) return phases;
  const OperatorSettings& hand = *configuration.operator_settings;
  for (std::size_t i = 0; i + 2 < hand.presses.size(); i += 3)
    phases.push_back({"the press of button " + std::to_string(static_cast<int>(hand.presses[i + 1])),
                      hand.presses[i], hand.presses[i] + hand.presses[i + 2]});
  add_schedule("operator.grip", hand.grip, phases);
  return phases;
}

}  // namespace remote_touch
