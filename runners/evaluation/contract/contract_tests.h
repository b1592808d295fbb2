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
#include <string>

#include "runners/experiment/catalog/catalog.h"

namespace remote_touch {

// Sets the settings that have no usable default, such as the file that `path` names. name: the entry's name.
using FillSettings = std::function<void(const std::string& name, const Parameters& settings)>;

// Registers a test for every entry and every rule of its contract: RendererContract.NoForceInFreeSpace/NAME.
// Must be called before RUN_ALL_TESTS(). The program then uses the built-in catalog with these entries added.
void register_contract_tests(const Catalog& catalog, const FillSettings& fill = {});

}  // namespace remote_touch
