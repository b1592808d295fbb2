// Sweeps that keep tallies: equal to the runs, the same bytes in any way, what is refused, what is merged.
#include "runners/sweep/tally_session.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "analysis/sweeps/sweep_means.h"
#include "core/kernels/isa.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_run.h"
#include "runners/sweep/tally_merge.h"
#include "tests/support/test_files.h"

namespace remote_touch::tally_session_test {
namespace {

// A run takes a millisecond.
constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12", "keep": "events",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 3},
           {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 7, "count": 4}],
  "replicates": 5, "measures": ["max_penetration", "popped_through", "first_pop_through_time"]})";

class TallySessions : public testing::Test {
 protected:
  static Sweep quick(const std::vector<std::string>& overrides = {}) {
    return Sweep::from_json(kQuick, "quick.json", overrides);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static TextAttributes attributes_of(const Sweep& sweep, const Shard& shard) {
    TextAttributes attributes = {{"config", sweep.to_json()}, {"version", "1"}};
    if (shard.count > 1) attributes.emplace_back("shard", shard.text());
    return attributes;
  }
  // Makes the tally. Returns its file. after: the number of finished runs at which it is interrupted.
  std::string made(const std::string& name, const Sweep& sweep, const Shard& shard = {},
                   std::size_t after = ~std::size_t{0}) const {
    TallySession session(sweep, shard, attributes_of(sweep, shard), file(name));
    std::atomic<bool> stop{false};
    try {
      session.run(kernels_for(best_isa()), &stop, [&](std::size_t done, std::size_t, std::size_t) {
        if (done >= after) stop = true;
      });
    } catch (const Interrupted&) {
    }
    return file(name);
  }
  static SweepTally tally_in(const std::string& name) { return read_tally(Hdf5Reader(name)).tally; }
  const TestFolder folder_{"tally_session_test"};
};

TEST_F(TallySessions, HaveTheSumsOfTheRuns) {
  const SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  const SweepTally tally = tally_in(made("t.h5", quick()));
  ASSERT_TRUE(tally.is_whole());
  for (std::size_t cell = 0; cell < runs.cell_count(); ++cell) {
    double sum = 0, least = 1e300;
    std::vector<std::uint64_t> popped;
    for (int replicate = 0; replicate < 5; ++replicate) {
      const std::size_t run = runs.run(cell, replicate);
      sum += runs.measure("max_penetration")[run];
      least = std::min(least, runs.measure("max_penetration")[run]);
      if (runs.measure("popped_through")[run] == 1) popped.push_back(run);
    }
    const CellTally& kept = tally.tallies[cell];
    EXPECT_EQ(kept.done, 5);
    EXPECT_NEAR(kept.measures[0].sum.value(), sum, 1e-15);
    EXPECT_EQ(kept.measures[0].least, least);
    EXPECT_EQ(kept.events, std::vector<std::vector<std::uint64_t>>{popped});
  }
}

// Interrupted and continued, with one and more threads, and in shards.
TEST_F(TallySessions, HaveTheSameBytesInAnyWay) {
  const std::string whole = bytes_of(made("whole.h5", quick()));
  omp_set_num_threads(1);
  made("again.h5", quick(), {}, 20);
  EXPECT_LT(tally_in(file("again.h5")).held.count(), 60u) << "it was interrupted";
  omp_set_num_threads(4);
  EXPECT_TRUE(bytes_of(made("again.h5", quick())) == whole);
  std::vector<std::string> shards;
  for (const int i : {3, 1, 2}) shards.push_back(made(std::to_string(i) + ".h5", quick(), {i, 3}));
  merge_tallies({shards, file("merged.h5")});
  EXPECT_TRUE(bytes_of(file("merged.h5")) == whole);
  merge_tallies({{shards[0], shards[2]}, file("two.h5"), Partial::yes});
  merge_tallies({{file("two.h5"), shards[1]}, file("all.h5")});
  EXPECT_TRUE(bytes_of(file("all.h5")) == whole);
}

TEST_F(TallySessions, AreRefusedWhereTheyDoNotFit) {
  const auto why = [&](const auto& call) { return refusal(call); };
  made("t.h5", quick());
  EXPECT_HAS(why([&] { made("t.h5", quick({"replicates=6"})); }), "t.h5: is of another configuration");
  EXPECT_HAS(why([&] { made("t.h5", quick({"keep=tally"})); }), "t.h5: is of another configuration");
  EXPECT_HAS(why([&] { made("s.h5", quick(), {13, 20}); }), "shard 13/20 has 0 cells: expected 1 to 1000000");
  EXPECT_HAS(why([&] { quick().plan(); }), "quick: keeps a tally (keep = events)");
  EXPECT_HAS(why([] { quick({"keep=all"}); }), R"(keep = "all": expected runs, tally or events)");
  EXPECT_HAS(why([] { quick({"refine.budget=100"}); }), "refinement needs the values of all runs");
  folder_.write("junk.h5", "junk");
  EXPECT_HAS(why([&] { made("junk.h5", quick()); }), "junk.h5: not a readable HDF5 file");
}

TEST_F(TallySessions, ThatAreUnfinishedAreMergedOnlyAsAPart) {
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

// Limits and means of a tally are those of its runs; what needs single runs is refused.
TEST_F(TallySessions, AnswerTheQuestionsThatNeedNoSingleRuns) {
  const SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  const SweepTally tally = tally_in(made("t.h5", quick()));
  const std::string config = quick().to_json();
  SweepQuestion question;
  question.limit = "popped_through";
  question.means = {"max_penetration", "popped_through", "first_pop_through_time"};
  question.by = {"noise_sigma_m"};
  const Figure ours = sweep_answer(tally, config, question), theirs = sweep_answer(runs, config, question);
  ASSERT_EQ(ours.tables.size(), theirs.tables.size());
  for (std::size_t t = 0; t < ours.tables.size(); ++t)
    for (const Column& column : ours.tables[t].columns)
      if (const auto* const values = std::get_if<std::vector<double>>(&column.values))
        for (std::size_t row = 0; row < values->size(); ++row) {
          const double expected = numbers(theirs.tables[t], column.name)[row];
          if (std::isnan(expected))
            EXPECT_TRUE(std::isnan((*values)[row])) << column.name;
          else
            EXPECT_NEAR((*values)[row], expected, 1e-12 + 1e-9 * std::abs(expected)) << column.name;
        }
  question = {};
  question.differences = {"max_penetration"}, question.between = "noise_sigma_m";
  EXPECT_HAS(refusal([&] { sweep_answer(tally, config, question); }), "a tally does not keep pairs of runs");
  question = {};
  question.limit = "max_penetration";
  EXPECT_HAS(refusal([&] { sweep_answer(tally, config, question); }),
             "a tally counts only the events themselves");
}

}  // namespace
}  // namespace remote_touch::tally_session_test
