// The rules of each contract; README.md has the list. A rule reports violations as failures of GoogleTest.
#pragma once

#include <span>

#include "runners/evaluation/contract/contract_tests.h"

namespace remote_touch {

template <class Entry>
struct ContractCheck {
  const char* name;
  void (*of)(const Entry& entry, const FillSettings& fill);
};

std::span<const ContractCheck<ScenarioEntry>> scenario_checks();
std::span<const ContractCheck<FixtureEntry>> fixture_checks();
std::span<const ContractCheck<TrajectoryEntry>> trajectory_checks();
std::span<const ContractCheck<RendererEntry>> renderer_checks();
std::span<const ContractCheck<Measure>> measure_checks();

// Checks that the defaults are within their ranges and valid together, that every setting has a line of help,
// and that the names of the settings differ from each other and from `name`.
void check_settings(Configurable& factory);

// Returns a new factory of the entry: its defaults, then the values that fill sets.
template <class Entry>
auto filled(const Entry& entry, const FillSettings& fill) {
  auto factory = entry.make();
  if (fill) fill(entry.name, factory->settings());
  return factory;
}

template <class Entry>
void its_defaults_are_valid(const Entry& entry, const FillSettings& fill) {
  check_settings(*filled(entry, fill));
}

}  // namespace remote_touch
