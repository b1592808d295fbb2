// Everything that an experiment can name. A new scenario, fixture rule, trajectory or renderer is one file
// pair and one line here; tests/runners/experiment/contract_test.cpp, or renderer_contract_test.cpp, then
// checks it against the contract of its interface.
#pragma once

#include <span>
#include <string>

#include "core/parameters/input_error.h"
#include "runners/experiment/factory.h"

namespace remote_touch {

std::span<const ScenarioEntry> scenarios();
std::span<const FixtureEntry> fixtures();
std::span<const TrajectoryEntry> trajectories();
std::span<const RendererEntry> renderers();

// The entry of that name; throws InputError with the known names.
template <class Entry>
const Entry& find_entry(std::span<const Entry> entries, const std::string& name, const std::string& path) {
  std::string known;
  for (const Entry& entry : entries) {
    if (name == entry.name) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InputError(path + " = \"" + name + "\"", "expected " + known);
}

}  // namespace remote_touch
