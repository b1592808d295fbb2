// The number of ticks of a run.
#include <gtest/gtest.h>

#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::run_length_test {
namespace {

Trace run(const std::string& duration_s) {
  return simulate(Experiment::load("fig4.11", {"duration_s=" + duration_s}));
}

// Sums of times carry rounding errors: 0.1 + 0.1 + 0.1 is above 0.3. An excess of a millionth of a tick
// counts as rounding.
TEST(RunLength, RoundingOfTheDurationAddsNoTick) {
  static_assert(0.1 + 0.1 + 0.1 > 0.3);
  for (const char* duration_s : {"0.3", "0.30000000000000004", "0.2999999999999999", "0.3000000005"}) {
    const Trace trace = run(duration_s);
    EXPECT_EQ(trace.length(), 300u) << duration_s;
    EXPECT_EQ(trace.time_s.back(), 0.299) << duration_s;
  }
}

TEST(RunLength, APartOfATickCountsAsATick) {
  EXPECT_EQ(run("0.30000001").length(), 301u);  // a hundred-thousandth of a tick more
  EXPECT_EQ(run("0.3009").length(), 301u);
  EXPECT_EQ(run("0.00001").length(), 1u);
  EXPECT_HAS(refusal([] { run("0.0000000005"); }), "shorter than a tick");
}

}  // namespace
}  // namespace remote_touch::run_length_test
