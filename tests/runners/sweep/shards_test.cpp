// Shards: how far those of a folder are, runs that are made again, and merging.
#include "runners/sweep/sweep_session.h"

#include <gtest/gtest.h>
#include <omp.h>
#include <algorithm>
#include <bit>
#include <chrono>
#include <filesystem>

#include "analysis/storage/other_processes.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/sweep/quick_sweeps.h"
#include "tests/support/test_files.h"

namespace remote_touch::shards_test {
namespace {

class ShardFolder : public testing::Test {
 protected:
  // Writes a shard of six runs, of which `done` are done, as its session would.
  std::filesystem::path write(const std::string& shard, int done, const std::string& title = "six") const {
    const Sweep sweep =
        Sweep::from_json(R"({"experiment": "fig4.12", "replicates": 6, "measures": ["max_force"],
      "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 4}]})",
                         "six.json", {"title=" + title});
    const Shard which = parse_shard(shard);
    SweepResult part = sweep.plan(which);
    for (int i = 0; i < done; ++i) part.state[static_cast<std::size_t>(i)] = RunState::done;
    const std::filesystem::path file = folder_ / (std::to_string(which.index) + ".h5");
    const TextAttributes attributes = {{"config", sweep.to_json()}, {"shard", shard}};
    if (done == 6)
      write_sweep(file, part, attributes);
    else
      write_sweep_in_progress(file, part, attributes);
    return file;
  }
  // Sets the time of the last change into the past.
  static void make_old(const std::filesystem::path& file) {
    std::filesystem::last_write_time(file,
                                     std::filesystem::file_time_type::clock::now() - std::chrono::minutes(5));
  }
  SweepProgress progress() const { return progress_of_shards(folder_ / "."); }
  const TestFolder folder_{"shard_folder_test"};
};

TEST_F(ShardFolder, HasFinishedRunningStoppedAndAbsentShards) {
  write("1/4", 6);
  write("2/4", 2);  // it was written just now
  const auto held = write("3/4", 3), left = write("4/4", 1);
  make_old(held), make_old(left);
  const FileLock lock(held);
  std::filesystem::remove(folder_ / "1.h5.lock");  // what a killed process leaves does not count
  const SweepProgress all = progress();
  EXPECT_EQ(all.title, "six");
  EXPECT_EQ(all.shard_count, 4);
  EXPECT_EQ(all.runs, 24u);
  EXPECT_EQ(all.done(), 12u);
  ASSERT_EQ(all.files.size(), 4u);
  EXPECT_EQ(all.files[0].state, ShardState::finished);
  EXPECT_EQ(all.files[1].state, ShardState::running);
  EXPECT_EQ(all.files[2].state, ShardState::running) << "its lock is held";
  EXPECT_EQ(all.files[3].state, ShardState::stopped);
  EXPECT_EQ(all.files[3].runs, 6u);
  EXPECT_NEAR(all.files[3].written_s_ago, 300, 30);
  std::filesystem::remove(left);
  EXPECT_EQ(progress().count(ShardState::absent), 1u);
}

TEST_F(ShardFolder, TheTimeLeftIsThatOfTheRunningShards) {
  SweepProgress all;
  all.runs = 1000;
  all.files = {{{{1}, 4}, "a", ShardState::running, 250, 100, 0, 0, 2.0},
               {{{2}, 4}, "b", ShardState::running, 250, 40, 10, 0, 3.0},
               {{{3}, 4}, "c", ShardState::stopped, 250, 50, 0, 900, 9.0}};
  EXPECT_DOUBLE_EQ(*all.left_s(), 800 / 5.0);
  all.files.clear();
  EXPECT_FALSE(all.left_s());
}

TEST_F(ShardFolder, MayHoldTallies) {
  SweepTally tally;
  tally.axes = {{"x", "1", "an axis", std::vector<double>{1, 2, 3, 4}}}, tally.replicates = 6;
  tally.measures = {{"max_force", "N", "a measure", {}}};
  const TallyLayout layout = tally.layout();
  for (std::uint64_t run = 0; run < 6; ++run) tally.add_done(layout, run, std::vector<double>{1}, 0);
  write_tally(folder_ / "1.h5", tally, {{"config", "{}"}, {"shard", "1/4"}});
  tally.cells.clear(), tally.tallies.clear(), tally.held = {};
  tally.add_failed(layout, 12, "no force");
  write_tally(folder_ / "3.h5", tally, {{"config", "{}"}, {"shard", "3/4"}});
  const SweepProgress all = progress();
  EXPECT_EQ(all.runs, 24u);
  EXPECT_EQ(all.files[0].state, ShardState::finished);
  EXPECT_EQ(all.files[1].state, ShardState::running);
  EXPECT_EQ(all.files[1].runs, 6u);
  EXPECT_EQ(all.failed(), 1u);
}

// Shard 1 is also in a part that was merged from 1 and 3, and that has all its runs.
TEST_F(ShardFolder, CountsAShardInTwoFilesOnce) {
  StoredSweep one = read_sweep(write("1/4", 6));
  write("2/4", 2);
  one.result.part->resize(12);
  for (std::size_t i = 6; i < 12; ++i) (*one.result.part)[i] = i + 6;
  for (Column& measure : one.result.measures) measure.values = std::vector<double>(12);
  one.result.state.assign(12, RunState::done), one.result.error.resize(12), one.result.notes.resize(12);
  write_sweep(folder_ / "merged.h5", one.result,
              {{"config", attribute(one.attributes, "config")}, {"shard", "1,3/4"}});
  const SweepProgress all = progress();
  ASSERT_EQ(all.files.size(), 2u);
  EXPECT_EQ(all.files[0].file, "merged.h5");
  EXPECT_EQ(all.done(), 14u);
  EXPECT_EQ(all.count(ShardState::absent), 1u);
}

TEST_F(ShardFolder, RefusesSeveralSweepsAndNone) {
  EXPECT_HAS(refusal([&] { progress(); }), "has no shards of a sweep");
  write("1/4", 6), write("2/4", 6, "other");
  EXPECT_HAS(refusal([&] { progress(); }), "2.h5: is a shard of another sweep than 1.h5");
}

// Runs of a sweep that are made again: equal where nothing is wrong; one wrong bit is found and named.

class Rechecks : public QuickSweeps {
 protected:
  Rechecks() : QuickSweeps("recheck_test") {}

  const Sweep sweep_ = quick({"keep=runs", "replicates=10"});
  SweepResult result_ = run_sweep(sweep_, {});

  std::vector<std::string> different() const { return recheck(result_, sweep_, {}).different; }
};

TEST_F(Rechecks, NameARunWithAnotherBit) {
  EXPECT_EQ(recheck(result_, sweep_, {}).made, 1u) << "run 99 of 120";
  EXPECT_TRUE(different().empty());
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

TEST_F(Rechecks, MakeEveryRunIfAsked) {
  result_.notes[50] ^= 1;
  std::vector<std::uint64_t> runs, wrong;
  RecheckOptions options;
  options.all = true;
  options.each = [&](std::uint64_t run, const std::string& difference) {
    runs.push_back(run);
    if (!difference.empty()) wrong.push_back(run);
  };
  EXPECT_EQ(recheck(result_, sweep_, options).made, 120u);
  ASSERT_EQ(runs.size(), 120u);
  EXPECT_TRUE(std::is_sorted(runs.begin(), runs.end()));
  EXPECT_EQ(wrong, std::vector<std::uint64_t>{50});
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
  RecheckOptions every_cell;
  every_cell.all = true;
  EXPECT_EQ(recheck(tally, sweep, every_cell).cells, 12u);
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

// Merging shards: some only, and what is refused. The test command_line/sweep has the bytes of whole sweeps.

class ShardMerge : public QuickSweeps {
 protected:
  ShardMerge() : QuickSweeps("shard_merge_test") {}

  static Sweep runs() { return quick({"keep=runs", "replicates=2", "duration_s=0.05"}); }
  // Writes a shard, or with "1/1" the whole sweep. Returns its file. after: see made().
  std::string shard(const std::string& text, std::size_t after = ~std::size_t{0}) const {
    std::string name = text + ".h5";
    std::replace(name.begin(), name.end(), '/', 'o');
    return made(name, runs(), parse_shard(text), after);
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
  const std::string one = shard("1/2"), two = shard("2/2", 0);
  EXPECT_HAS(why({one, two}), "2o2.h5: is not finished (12 runs are left)");
  const StoredSweep early = read_sweep(merged({one, two}, Partial::yes));
  EXPECT_EQ(early.result.runs_in(RunState::done).size(), 12u);
  EXPECT_EQ(early.result.runs_in(RunState::pending).size(), 12u);
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
  const SweepResult few = runs().plan({2, 4});
  write_sweep(file("few.h5"), few, two.attributes);
  EXPECT_HAS(why({one, file("few.h5")}), "no part holds run 6");
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

}  // namespace
}  // namespace remote_touch::shards_test
