// Shards of a tally: merged they are the bytes of the whole; what is missing, doubled or unfinished is
// refused.
#include "runners/sweep/shards/tally_merge.h"

#include <gtest/gtest.h>
#include <omp.h>

#include "analysis/tally/tally_file.h"
#include "tests/runners/sweep/quick_tallies.h"

namespace remote_touch::tally_merge_test {
namespace {

class TallyMerges : public QuickTallies {
 protected:
  TallyMerges() : QuickTallies("tally_merge_test") {}
};

TEST_F(TallyMerges, HaveTheBytesOfTheWhole) {
  const std::string whole = bytes_of(made("whole.h5", quick()));
  std::vector<std::string> shards;
  for (const int i : {3, 1, 2}) shards.push_back(made(std::to_string(i) + ".h5", quick(), {i, 3}));
  merge_tallies({shards, file("merged.h5")});
  EXPECT_TRUE(bytes_of(file("merged.h5")) == whole);
  merge_tallies({{shards[0], shards[2]}, file("two.h5"), Partial::yes});
  merge_tallies({{file("two.h5"), shards[1]}, file("all.h5")});
  EXPECT_TRUE(bytes_of(file("all.h5")) == whole);
}

TEST_F(TallyMerges, TakeUnfinishedShardsOnlyAsAPart) {
  omp_set_num_threads(1);
  const std::string one = made("1.h5", quick(), {1, 2}, 16), two = made("2.h5", quick(), {2, 2});
  const std::size_t left = 30 - tally_in(one).held.count();
  ASSERT_GT(left, 0u);
  EXPECT_HAS(refusal([&] {
               merge_tallies({{one, two}, file("m.h5")});
             }),
             "1.h5: is not finished (" + std::to_string(left) + " runs are left)");
  EXPECT_EQ(merge_tallies({{one, two}, file("m.h5"), Partial::yes}).tally.held.count(), 60 - left);
  EXPECT_HAS(refusal([&] {
               merge_tallies({{two}, file("m.h5"), Partial::yes});
             }),
             "holds runs that the shards do not");
  EXPECT_HAS(refusal([&] { merge_tallies({{two, two}, file("x.h5")}); }), "is shard 2/2, which is also in");
}

// Its sums contain the wrong runs, which would enter the sums of the merged file.
TEST_F(TallyMerges, RefuseAShardWithWrongRuns) {
  const std::string one = made("1.h5", quick(), {1, 2}), two = made("2.h5", quick(), {2, 2}),
                    whole = file("w.h5");
  {
    const Sweep sweep = quick();
    TallySession session(sweep, {2, 2}, attributes_of(sweep, {2, 2}), two);
    session.distrust("run 7 differs");
  }
  for (const Partial partial : {Partial::no, Partial::yes})
    EXPECT_HAS(refusal([&] {
                 merge_tallies({{one, two}, whole, partial});
               }),
               "2.h5: has runs of a machine that computed wrongly (run 7 differs): expected a new file");
  EXPECT_FALSE(std::filesystem::exists(whole));
  EXPECT_HAS(refusal([&] {
               made("2.h5", quick(), {2, 2});
             }),
             "2.h5: has runs of a machine that computed wrongly");
  EXPECT_EQ(distrust_of(read_tally(Hdf5Reader(two)).attributes).substr(0, 35),
            "some runs are WRONG: run 7 differs;");
}

}  // namespace
}  // namespace remote_touch::tally_merge_test
