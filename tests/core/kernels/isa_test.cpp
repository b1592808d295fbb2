#include "core/kernels/isa.h"

#include <gtest/gtest.h>

#include <string>

namespace remote_touch::isa_test {
namespace {

TEST(SupportedKernels, AreTheLevelsUpToTheBestInRisingOrder) {
  const auto supported = supported_kernels();
  const std::string names[] = {"x86-64", "x86-64-v3", "x86-64-v4"};
  ASSERT_EQ(supported.size(), static_cast<std::size_t>(best_isa()) + 1);
  for (std::size_t i = 0; i < supported.size(); ++i) {
    EXPECT_EQ(supported[i]->isa, names[i]);
    EXPECT_EQ(supported[i], &kernels_for(static_cast<Isa>(i)));
  }
}

}  // namespace
}  // namespace remote_touch::isa_test
