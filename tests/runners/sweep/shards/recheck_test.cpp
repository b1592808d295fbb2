// Runs of a sweep that are made again: equal where nothing is wrong; one wrong bit is found and named.
#include "runners/sweep/shards/recheck.h"

#include <gtest/gtest.h>

#include <bit>

#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/sweep/quick_tallies.h"

namespace remote_touch::recheck_test {
namespace {

class Rechecks : public QuickTallies {
 protected:
  Rechecks() : QuickTallies("recheck_test") {}

  const Sweep sweep_ = quick({"keep=runs", "replicates=10"});
  SweepResult result_ = run_sweep(sweep_, {});

  std::vector<std::string> different() const { return recheck(result_, sweep_, {}).different; }
};

TEST_F(Rechecks, FindNothingInEqualBits) {
  const Recheck check = recheck(result_, sweep_, {});
  EXPECT_EQ(check.made, 1u) << "run 99 of 120";
  EXPECT_TRUE(check.different.empty());
}

TEST_F(Rechecks, NameARunWithAnotherBit) {
  double& value = std::get<std::vector<double>>(result_.measures[0].values)[99];
  value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ 1);
  ASSERT_EQ(different().size(), 1u);
  EXPECT_HAS(different()[0], "run 99: max_penetration = ");
  EXPECT_HAS(different()[0], ", now ");
}

TEST_F(Rechecks, CompareNotesAndStates) {
  result_.notes[99] ^= 1;
  EXPECT_EQ(different(), std::vector<std::string>{"run 99: has other notes now"});
  result_.state[99] = RunState::failed;
  EXPECT_EQ(different(), std::vector<std::string>{"run 99: failed, now is done"});
}

TEST_F(Rechecks, TakeOnlyTheRunsOfAPart) {
  SweepResult part = sweep_.part({3, 5, 7});
  part.state[0] = RunState::pending;
  EXPECT_EQ(recheck(part, sweep_, {}).made, 0u) << "nothing was made";
  ASSERT_EQ(do_pending_runs(sweep_, part, {}), 0u);
  EXPECT_EQ(recheck(part, sweep_, {}).made, 1u) << "the first one, because no number is chosen";
  EXPECT_TRUE(recheck(part, sweep_, {}).different.empty());
}

TEST_F(Rechecks, EndWhenTheyAreStopped) {
  std::atomic<bool> stop{true};
  EXPECT_THROW(recheck(result_, sweep_, {nullptr, &stop}), Interrupted);
}

TEST_F(Rechecks, CompareAWholeCellOfATally) {
  const Sweep sweep = quick();
  const SweepTally made_once = tally_in(made("t.h5", sweep));
  SweepTally tally = made_once;
  EXPECT_EQ(recheck(tally, sweep, {}).made, 5u) << "one cell of 12";
  EXPECT_TRUE(recheck(tally, sweep, {}).different.empty());
  EXPECT_EQ(recheck(tally, sweep, {}).cells, 1u);
  EXPECT_EQ(recheck(tally, sweep, {}).cells_in, 12u);
  tally.tallies[6].measures[0].add(0.001);
  ASSERT_EQ(recheck(tally, sweep, {}).different.size(), 1u);
  EXPECT_HAS(recheck(tally, sweep, {}).different[0], "cell 6: mean of max_penetration = ");
  tally = made_once;
  tally.tallies[6].measures[0].greatest *= 2;
  EXPECT_HAS(recheck(tally, sweep, {}).different[0], "cell 6: greatest value of max_penetration = ");
  tally = made_once;
  tally.tallies[6].measures[0].squares = {};
  EXPECT_EQ(recheck(tally, sweep, {}).different,
            std::vector<std::string>{"cell 6: other values of max_penetration now, with the same mean"});
  tally = made_once;
  tally.tallies[6].notes[0].runs += 1;
  EXPECT_EQ(recheck(tally, sweep, {}).different,
            std::vector<std::string>{"cell 6: other failed runs, notes or events now"});
}

TEST(RecheckedNumbers, AreOneOfEachThousand) {
  for (std::uint64_t thousand = 0; thousand < 2000; ++thousand) {
    int chosen = 0;
    for (std::uint64_t i = 0; i < 1000; ++i) chosen += is_rechecked(1000 * thousand + i);
    ASSERT_EQ(chosen, 1) << thousand;
  }
}

}  // namespace
}  // namespace remote_touch::recheck_test
