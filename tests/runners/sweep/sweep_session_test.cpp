// Sweeps that keep tallies: equal to the runs, the same bytes in any way, what is refused.
#include "runners/sweep/sweep_session.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "analysis/sweeps/sweep_means.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/sweep/quick_sweeps.h"

namespace remote_touch::sweep_session_test {
namespace {

class TallySessions : public QuickSweeps {
 protected:
  TallySessions() : QuickSweeps("tally_session_test") {}
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

// Interrupted and continued, with one and more threads.
TEST_F(TallySessions, HaveTheSameBytesInAnyWay) {
  const std::string whole = bytes_of(made("whole.h5", quick()));
  omp_set_num_threads(1);
  made("again.h5", quick(), {}, 1);  // after the first batch: on a fast machine the second has all the rest
  EXPECT_LT(tally_in(file("again.h5")).held.count(), 60u) << "it was interrupted";
  omp_set_num_threads(4);
  EXPECT_TRUE(bytes_of(made("again.h5", quick())) == whole);
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
  const Sweep longer = quick({"replicates=6"});
  EXPECT_HAS(why([&] { plan_in_file(longer, {}, attributes_of(longer, {}), file("t.h5")); }),
             "t.h5: is of another configuration, first in replicates 5 against 6");
  folder_.write("junk.h5", "junk");
  EXPECT_HAS(why([&] { made("junk.h5", quick()); }), "junk.h5: not a readable HDF5 file");
}

// Limits and means of a tally are those of its runs; what needs single runs is refused.
TEST_F(TallySessions, AnswerTheQuestionsThatNeedNoSingleRuns) {
  const SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  const SweepTally tally = tally_in(made("t.h5", quick()));
  const std::string config = quick().to_json();
  SweepQuestion question;
  question.limit = "popped_through";
  question.means = {"max_penetration", "popped_through", "first_pop_through_time"};
  const Figure ours = sweep_answer(tally, config, question), theirs = sweep_answer(runs, config, question);
  ASSERT_EQ(ours.tables.size(), theirs.tables.size());
  EXPECT_EQ(ours.caption, theirs.caption);
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
  for (std::size_t t = 0; t < ours.tables.size(); ++t)
    for (std::size_t i = 0; i < ours.tables[t].columns.size(); ++i) {
      const Column &column = ours.tables[t].columns[i], &expected = theirs.tables[t].columns[i];
      EXPECT_EQ(column.name, expected.name);
      if (std::holds_alternative<std::vector<std::int32_t>>(column.values)) {
        EXPECT_EQ(column.values, expected.values) << column.name;
      }
    }
  question = {};
  question.differences = {"max_penetration"}, question.between = "noise_sigma_m";
  EXPECT_HAS(refusal([&] { sweep_answer(tally, config, question); }), "a tally does not keep pairs of runs");
  question = {};
  question.limit = "max_penetration";
  EXPECT_HAS(refusal([&] { sweep_answer(tally, config, question); }),
             "a tally counts only the events themselves");
}

// An answer states in how many runs it is unknown whether the event happened.
TEST_F(TallySessions, AnswersTellHowManyRunsAreUnknown) {
  SweepResult runs = run_sweep(quick({"keep=runs"}), {});
  SweepTally tally = tally_in(made("t.h5", quick()));
  const std::string config = quick().to_json();
  SweepQuestion question;
  question.limit = "popped_through", question.direction = "rises";
  const auto unknown_in = [](const Figure& answer) {
    double sum = 0;
    for (const Column& column : answer.tables.front().columns)
      if (column.name == "unknown")
        for (const std::int32_t count : std::get<std::vector<std::int32_t>>(column.values)) sum += count;
    return sum;
  };
  EXPECT_EQ(unknown_in(sweep_answer(runs, config, question)), 0);
  EXPECT_EQ(unknown_in(sweep_answer(tally, config, question)), 0);
  std::get<std::vector<double>>(runs.measures[1].values)[3] = std::nan("");
  tally.tallies[0].measures[1].unknown = 1;
  EXPECT_EQ(unknown_in(sweep_answer(runs, config, question)), 1);
  EXPECT_EQ(unknown_in(sweep_answer(tally, config, question)), 1);
}

}  // namespace
}  // namespace remote_touch::sweep_session_test
