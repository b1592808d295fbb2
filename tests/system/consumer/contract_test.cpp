// The contracts, applied to the entries that this laboratory adds.
#include <gtest/gtest.h>
#include <runners/evaluation/contract/contract_tests.h>

#include "entries.h"

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  remote_touch::Catalog own;
  lab::add_entries(own);
  remote_touch::register_contract_tests(own);
  return RUN_ALL_TESTS();
}
