#include "analysis/trace/formatted.h"

#include <gtest/gtest.h>

namespace remote_touch::formatted_test {
namespace {

TEST(Formatted, IsWhatPrintfPrintsAtAnyLength) {
  EXPECT_EQ(formatted("%zu of %s, %.3g %%", std::size_t{2}, "three", 0.25), "2 of three, 0.25 %");
  EXPECT_EQ(formatted("%s", ""), "");
  const std::string name(5000, 'x');
  EXPECT_EQ(formatted("%s!", name.c_str()), name + "!");
}

}  // namespace
}  // namespace remote_touch::formatted_test
