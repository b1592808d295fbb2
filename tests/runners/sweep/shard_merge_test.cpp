#include "runners/sweep/sweep_session.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <map>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "runners/sweep/stored_sweep.h"
#include "tests/runners/sweep/quick_sweeps.h"
#include "tests/support/test_files.h"

namespace remote_touch::shard_merge_test {
namespace {

// Merging shards: the bytes of a whole sweep, some shards only, and what is refused.

class ShardMerge : public QuickSweeps {
 protected:
  ShardMerge() : QuickSweeps("shard_merge_test") {}

  static Sweep runs(const std::vector<std::string>& overrides) {
    std::vector<std::string> all = {"keep=runs", "replicates=2", "duration_s=0.05"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return quick(all);
  }
  // Writes a shard, or with "1/1" the whole sweep. Returns its file. after: see made().
  std::string shard(const std::string& text, const std::vector<std::string>& overrides = {},
                    std::size_t after = ~std::size_t{0}) const {
    std::string name = text + (overrides.empty() ? "" : overrides.front()) + ".h5";
    for (char& c : name)
      if (c == '/') c = 'o';
    return made(name, runs(overrides), parse_shard(text), after);
  }
  std::string merged(const std::vector<std::string>& shards, Partial partial = Partial::no) {
    const std::string output = file("merged" + std::to_string(++merges_) + ".h5");
    merge_shards({shards, output, partial}, [](const SweepResult&) {});
    return output;
  }
  std::string why(const std::vector<std::string>& shards, Partial partial = Partial::no) {
    return refusal([&] { merged(shards, partial); });
  }

  int merges_ = 0;
};

// Also with more shards than cells, so that some shards are empty.
TEST_F(ShardMerge, HasTheBytesOfTheWholeSweep) {
  for (const std::vector<std::string>& overrides :
       {std::vector<std::string>{},
        {"replicates=300"},
        {"refine.budget=70", "refine.levels=1", "refine.max_replicates=5"}}) {
    const bool is_refined = overrides.size() == 3;
    for (const int count : {2, 5, 15}) {
      std::vector<std::string> shards;
      for (int i = count; i >= 1; --i) shards.push_back(shard(Shard{i, count}.text(), overrides));
      const std::string output = merged(shards);
      // Refinement goes on from the merged first round; the whole sweep has all rounds.
      if (is_refined) made(std::filesystem::path(output).filename(), runs(overrides));
      EXPECT_TRUE(bytes_of(output) == bytes_of(shard("1/1", overrides))) << count;
    }
  }
}

TEST_F(ShardMerge, OfSomeShardsIsAPartThatCanBeMergedAgain) {
  std::vector<std::string> all;
  for (int i = 1; i <= 5; ++i) all.push_back(shard(Shard{i, 5}.text()));
  EXPECT_HAS(why({all[0], all[1], all[3]}), "shards 3,5/5 are missing: expected all of them, or --partial");
  const std::string three = merged({all[3], all[0], all[1]}, Partial::yes),
                    two = merged({all[2], all[4]}, Partial::yes);
  const StoredSweep part = read_sweep(three);
  EXPECT_EQ(attribute(part.attributes, "shard"), "1-2,4/5");
  EXPECT_EQ(part.result.runs_in(RunState::done).size(), 16u) << "8 of 12 cells";
  EXPECT_EQ(read_stored_sweep(three).result.runs_in(RunState::elsewhere).size(), 8u);
  EXPECT_EQ(bytes_of(merged({two, three})), bytes_of(shard("1/1")));
  EXPECT_HAS(why({three, all[1], two}), "is shard 2/5, which is also in " + three);
}

TEST_F(ShardMerge, TakesAnUnfinishedShardOnlyAsAPart) {
  const std::string one = shard("1/2"), two = shard("2/2", {}, 0);
  EXPECT_HAS(why({one, two}), "2o2.h5: is not finished (12 runs are left)");
  const StoredSweep early = read_sweep(merged({one, two}, Partial::yes));
  EXPECT_EQ(early.result.runs_in(RunState::done).size(), 12u);
  EXPECT_EQ(early.result.runs_in(RunState::pending).size(), 12u);
}

TEST_F(ShardMerge, RefusesWhatDoesNotBelongTogether) {
  const std::string one = shard("1/2"), two = shard("2/2");
  EXPECT_HAS(why({one}), "merge: shard 2/2 is missing");
  EXPECT_HAS(why({one, one}), "is shard 1/2, which is also in");
  EXPECT_HAS(why({one, shard("2/3")}), "is shard 2/3: expected shards of a sweep in 2 shards, as " + one);
  EXPECT_HAS(why({one, shard("2/2", {"replicates=3"})}), "has another config than");
  EXPECT_HAS(why({one, shard("1/1")}), "is the result of a whole sweep");
  EXPECT_HAS(why({one, file("absent.h5")}), "absent.h5: no such file");
  EXPECT_HAS(refusal([&] {
               merge_shards({{one, two}, two}, [](const SweepResult&) {});
             }),
             "is one of the shards");
  std::string bytes = bytes_of(two);
  bytes[bytes.size() / 2] ^= 1;
  EXPECT_HAS(why({one, folder_.write("flipped.h5", bytes)}), "flipped.h5: damaged or modified");
}

// A forged shard, with the seal of this program: its runs are those of another shard, or are not all there.
TEST_F(ShardMerge, NamesAShardThatHoldsOtherRuns) {
  const std::string one = shard("1/2");
  StoredSweep two = read_sweep(shard("2/2"));
  two.result.part->front() = 0;
  write_sweep(file("twin.h5"), two.result, two.attributes);
  EXPECT_HAS(why({one, file("twin.h5")}), "twin.h5: holds run 0, as another part does: expected once");
  two.result.part->front() = 99;
  write_sweep(file("far.h5"), two.result, two.attributes);
  EXPECT_HAS(why({one, file("far.h5")}), "far.h5: damaged (");
  const SweepResult few = runs({}).plan({2, 4});
  write_sweep(file("few.h5"), few, two.attributes);
  EXPECT_HAS(why({one, file("few.h5")}), "no part holds run 6");
}

TEST_F(ShardMerge, LeavesNoOtherFile) {
  merged({shard("1/2"), shard("2/2")});
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "."))
    EXPECT_TRUE(entry.path().extension() == ".h5") << entry.path();
}

// Shards of a tally: merged they are the bytes of the whole; what is missing, doubled or unfinished is
// refused.

class TallyMerges : public QuickSweeps {
 protected:
  TallyMerges() : QuickSweeps("tally_merge_test") {}
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
  EXPECT_EQ(merge_tallies({{one, two}, file("m.h5"), Partial::yes}).held.count(), 60 - left);
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
    SweepSession session(sweep, {2, 2}, attributes_of(sweep, {2, 2}), two);
    session.forget({}, "run 7 differs");
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
}  // namespace remote_touch::shard_merge_test
