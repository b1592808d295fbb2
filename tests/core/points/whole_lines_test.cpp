#include "core/points/whole_lines.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace remote_touch::whole_lines_test {
namespace {

TEST(WholeLines, ColumnsBeginAtALineAndKeepTheirNumbers) {
  for (const std::size_t size : {1u, 7u, 100u, 100000u}) {
    LineVector<double> column(1, 0.0), other;
    for (std::size_t i = 1; i < size; ++i) {
      column.push_back(static_cast<double>(i));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column.data()) % kLineBytes, 0u);
    }
    other = column;
    EXPECT_EQ(other, column);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(other.data()) % kLineBytes, 0u);
  }
}

}  // namespace
}  // namespace remote_touch::whole_lines_test
