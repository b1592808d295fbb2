#include "core/rendering/renderer.h"

#include <gtest/gtest.h>

#include <limits>

namespace remote_touch::renderer_test {
namespace {

TEST(ElapsedTicks, IsOneFromTickToTickWhateverTheRounding) {
  for (const double rate_hz : {100.0, 250.0, 1000.0, 3000.0})
    for (int tick = 0; tick < 100000; tick += 7)
      ASSERT_EQ(elapsed_ticks(tick / rate_hz, (tick + 1) / rate_hz, rate_hz), 1) << tick;
}

TEST(ElapsedTicks, CountsMissedTicks) {
  EXPECT_EQ(elapsed_ticks(0.1, 0.104, 1000), 4);
  EXPECT_EQ(elapsed_ticks(2, 5, 250), 750);
}

TEST(ElapsedTicks, IsNeverBelowOne) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(elapsed_ticks(1, 1, 1000), 1);
  EXPECT_EQ(elapsed_ticks(1, 0.5, 1000), 1);
  EXPECT_EQ(elapsed_ticks(kNan, 1, 1000), 1);
  EXPECT_EQ(elapsed_ticks(1, kNan, 1000), 1);
}

}  // namespace
}  // namespace remote_touch::renderer_test
