// Runs the contracts of a catalog's entries as tests. Your own test program checks with them that your
// renderers, scenarios, fixture rules, trajectories and measures keep what every part of this program relies
// on.
//
//   int main(int argc, char** argv) {
//     testing::InitGoogleTest(&argc, argv);
//     remote_touch::register_contract_tests(my_entries());  // a Catalog of your own entries alone
//     return RUN_ALL_TESTS();
//   }
//
// runners/evaluation/contract/README.md describes each contract in one line.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>

#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/experiment/catalog/catalog.h"

// A flat cloud as a frame, for tests and benchmarks.
namespace remote_touch::scenes {

// Returns n x n points in the plane of height y, centred about the y axis.
inline PointCloud flat_grid(int n, double spacing = 0.0015, double y = 0) {
  PointCloud cloud;
  cloud.grid_columns = n;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      cloud.append({(i - 0.5 * (n - 1)) * spacing, y, (j - 0.5 * (n - 1)) * spacing});
  return cloud;
}

inline Frame frame(PointCloud cloud, int index = 0, double rate_hz = 30) {
  const double time = index / rate_hz;
  return {index, time, time, make_search(std::move(cloud))};
}

inline const Kernels& kernels() {
  return kernels_for(best_isa());
}

}  // namespace remote_touch::scenes

namespace remote_touch {

// Sets the settings that have no usable default, such as the file that `path` names. name: the entry's name.
using FillSettings = std::function<void(const std::string& name, const Parameters& settings)>;

// Registers a test for every entry and every rule of its contract: RendererContract.NoForceInFreeSpace/NAME.
// Must be called before RUN_ALL_TESTS(). The program then uses the built-in catalog with these entries added.
void register_contract_tests(const Catalog& catalog, const FillSettings& fill = {});

// The rules of each contract; README.md has the list. A rule reports violations as failures of GoogleTest.

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
