// The contracts of a catalog's entries as tests: a test program of yours holds your renderers, scenarios,
// fixture rules, trajectories and measures to what every part of this program relies on.
//
//   int main(int argc, char** argv) {
//     testing::InitGoogleTest(&argc, argv);
//     remote_touch::contract_tests(my_entries());  // a Catalog of your own entries alone
//     return RUN_ALL_TESTS();
//   }
//
// What the contracts are, one line each: runners/evaluation/contract/README.md.
#pragma once

#include <functional>
#include <string>

#include "runners/experiment/catalog/catalog.h"

namespace remote_touch {

// Gives settings that have no usable default a value, such as the file that `path` names. name: of the entry.
using FillSettings = std::function<void(const std::string& name, const Parameters& settings)>;

// Registers a test for every entry and every rule of its contract: RendererContract.NoForceInFreeSpace/NAME.
// Before RUN_ALL_TESTS(). From then on the program uses the built-in catalog with these entries in addition.
void contract_tests(const Catalog& catalog, const FillSettings& fill = {});

}  // namespace remote_touch
