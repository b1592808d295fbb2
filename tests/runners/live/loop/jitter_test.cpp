// Ticks that count as late, on a simulated clock. `remote-touch jitter` reports how late this machine is.
#include "runners/live/loop/jitter.h"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/doubles/simulated_clock.h"

namespace remote_touch::jitter_test {
namespace {

// A rate of 3 kHz has a period of 333333 ns: after 300 ticks the loop is 0.1 us before a grid of 1 / 3000 s.
TEST(Jitter, NoTickIsLateIfAllComeInTime) {
  for (const auto& [duration_s, rate_hz, ticks] : {std::tuple{0.5, 1000, 500u}, {0.1, 3000, 300u}}) {
    SCOPED_TRACE(rate_hz);
    SimulatedClock clock;
    const Jitter jitter = measure_jitter(duration_s, rate_hz, nullptr, clock);
    ASSERT_EQ(jitter.late_s.size(), ticks);
    for (const double late_s : jitter.late_s) EXPECT_NEAR(late_s, 0, 1e-12);
    EXPECT_EQ(jitter.missed, 0);
  }
}

// Something else runs from 5.2 to 7.7 ms. The tick of 6 ms never comes, and that of 7 ms comes 0.7 ms late.
TEST(Jitter, ALateTickIsLateAndOneThatNeverCameIsMissed) {
  SimulatedClock clock;
  clock.at(0.0052, [&] { clock.sleep_s(0.0025); });
  const Jitter jitter = measure_jitter(0.01, 1000, nullptr, clock);
  ASSERT_EQ(jitter.late_s.size(), 9u);
  EXPECT_EQ(jitter.missed, 1);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(jitter.late_s[i], i == 6 ? 0.7e-3 : 0, 1e-12) << i;
}

TEST(Jitter, AStopEndsIt) {
  SimulatedClock clock;
  std::atomic<bool> stop = false;
  clock.at(0.0035, [&] { stop = true; });
  EXPECT_EQ(measure_jitter(10, 1000, &stop, clock).late_s.size(), 4u);
}

}  // namespace
}  // namespace remote_touch::jitter_test
