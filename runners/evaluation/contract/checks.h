// The rules of each contract; README.md has the list. A rule reports what is wrong as failures of GoogleTest.
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

// The defaults are in their ranges and valid together; names are different, and none is `name`.
void check_settings(Configurable& factory);

// A new factory of the entry, with its defaults and what fill adds.
template <class Entry>
auto filled(const Entry& entry, const FillSettings& fill) {
  auto factory = entry.make();
  if (fill) fill(entry.name, factory->settings());
  return factory;
}

}  // namespace remote_touch
