// The page of a sweep, the runs that it shows by default, and descriptions of everything that has a name.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/presentation/descriptions.h"
#include "runners/presentation/result_pages.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/presentation/read_page.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_page_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A sweep with axes of these lengths, whose runs are all done with these values.
SweepResult sweep_of(std::vector<std::size_t> lengths, int replicates, std::vector<double> values) {
  SweepResult result;
  for (const std::size_t length : lengths)
    result.axes.push_back({"axis", "1", "", std::vector<double>(length, 0.0), 1, {}});
  result.replicates = replicates;
  result.measures.push_back({"popped_through", "1", "", std::vector<double>(), 1, {}});
  result.start(false);
  result.measures.front().values = std::move(values);
  result.state.assign(result.run_count(), RunState::done);
  return result;
}

std::vector<std::size_t> chosen(const SweepResult& result, std::size_t max = 6) {
  return default_runs(result, result.measure("popped_through"), 0.5, max);
}

// Runs are marked by 0 where they hold and by 1 where they fail.
TEST(DefaultRuns, AreFailuresNearestToRunsThatHold) {
  using Runs = std::vector<std::size_t>;
  // Rows of the first axis:
  //   0 0 1 1
  //   0 1 1 1
  //   0 0 0 1
  EXPECT_EQ(chosen(sweep_of({3, 4}, 1, {0, 0, 1, 1, 0, 1, 1, 1, 0, 0, 0, 1})), (Runs{2, 5, 6, 11}));
  std::vector<double> rows;
  for (int row = 0; row < 20; ++row) rows.insert(rows.end(), {0.0, 1.0});
  EXPECT_EQ(chosen(sweep_of({20, 2}, 1, rows), 3), (Runs{1, 19, 39})) << "they are spread evenly";
  EXPECT_EQ(chosen(sweep_of({20, 2}, 1, rows), 1), Runs{1});
  // The first failed replicate of a cell that mostly fails: one of three is not most.
  EXPECT_EQ(chosen(sweep_of({3}, 3, {0, 0, 0, 0, 1, 1, 1, 1, 1})), Runs{4});
  EXPECT_EQ(chosen(sweep_of({3}, 3, {0, 0, 0, 0, 1, 0, 1, 1, 1})), Runs{6});
  // Refinement leaves cells out; the next one that was run counts.
  SweepResult refined = sweep_of({5}, 1, {0, kNaN, kNaN, 1, 1});
  refined.state[1] = refined.state[2] = RunState::not_sampled;
  EXPECT_EQ(chosen(refined), Runs{3});
  // Any failures, or else the extremes, if there is no limit.
  EXPECT_EQ(chosen(sweep_of({3}, 1, {1, 1, 1})), (Runs{0, 1, 2}));
  EXPECT_EQ(chosen(sweep_of({4}, 1, {0.2, 0.4, 0.1, kNaN})), (Runs{1, 2}));
  EXPECT_EQ(chosen(sweep_of({4}, 1, {0.2, 0.4, 0.1, kNaN}), 1), Runs{1});
  EXPECT_EQ(chosen(sweep_of({2}, 1, {kNaN, kNaN})), Runs{0});
  SweepResult none = sweep_of({2}, 1, {kNaN, kNaN});
  none.state.assign(2, RunState::failed);
  EXPECT_TRUE(chosen(none).empty());
}

constexpr const char* kSweep = R"({"title": "few lifts", "experiment": "fig4.12", "set": {"duration_s": 0.7},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.003, "count": 2},
           {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 20, "count": 3}],
  "measures": ["popped_through", "max_penetration"]})";

class SweepPageTest : public testing::Test {
 protected:
  void SetUp() override {
    options_.kernels = &scenes::kernels();
    stored_ = run_sweep(sweep_, {});
    write(stored_);
  }
  void write(const SweepResult& result) {
    write_sweep(folder_ / "map.h5", result, provenance(sweep_.to_json(), "a test", ""));
  }
  ReadPage page(const std::vector<std::string>& cells) {
    return ReadPage(sweep_page(folder_ / "map.h5", cells, options_).html);
  }

  const Sweep sweep_ = Sweep::from_json(kSweep, "a test");
  SweepResult stored_;
  ViewOptions options_;
  TestFolder folder_{"sweep_page"};
};

TEST_F(SweepPageTest, HasTheMapAndTheRunsOfTheNamedCells) {
  const ReadPage read = page({"1,2", "0,0"});
  const nlohmann::ordered_json& map = read.json["sweep"];
  EXPECT_EQ(map["runs"], (std::vector<int>{0, 5}));
  EXPECT_EQ(map["axes"][0]["values"], (std::vector<double>{0, 0.003}));
  EXPECT_EQ(map["axes"][1]["name"], "acceleration_m_per_s2");
  EXPECT_EQ(map["done"], (std::vector<int>(6, 1)));
  EXPECT_EQ(read.numbers<double>(map["measures"][1]["numbers"]), stored_.measure("max_penetration"));
  ASSERT_EQ(read.json["runs"].size(), 2u);
  const Trace again = simulate(sweep_.experiment(5, 0));
  EXPECT_EQ(read.numbers<std::int32_t>(read.column("contact_count", 1)), again.contact_count);
  EXPECT_EQ(read.json["runs"][1]["note"], "");
}

// A mean can then state how many of the runs have no value.
TEST_F(SweepPageTest, HasTheNumberOfFinishedRunsOfEachCell) {
  SweepResult failed = stored_;
  failed.state[2] = RunState::failed, failed.error[2] = "no memory";
  for (Column& measure : failed.measures) std::get<std::vector<double>>(measure.values)[2] = std::nan("");
  write(failed);
  EXPECT_EQ(page({"0,0"}).json["sweep"]["done"], (std::vector<int>{1, 1, 0, 1, 1, 1}));
}

TEST_F(SweepPageTest, ReportsARunThatDiffersFromTheStoredOne) {
  SweepResult other = stored_;
  std::get<std::vector<double>>(other.measures[1].values)[5] += 1e-9;
  write(other);
  const ViewPage page = sweep_page(folder_ / "map.h5", {"1,2", "0,0"}, options_);
  EXPECT_HAS(page.shown, "its measures differ");
  const ReadPage read(page.html);
  EXPECT_EQ(read.json["runs"][0]["note"], "");
  EXPECT_HAS(read.json["runs"][1]["note"].get<std::string>(), "its measures differ");
}

// Every run of this sweep ends at 0.3 s, before the press begins.
TEST_F(SweepPageTest, ShowsNotesAsCountsAndAtTheirRun) {
  const Sweep ends_before = Sweep::from_json(kSweep, "a test", {"duration_s=0.3"});
  const SweepResult result = run_sweep(ends_before, {});
  write_sweep(folder_ / "map.h5", result, provenance(ends_before.to_json(), "a test", ""));
  const ReadPage read = page({"1,2"});
  EXPECT_HAS(read.json["sweep"]["notes"].dump(), "6 of 6 runs: phase not reached: ");
  EXPECT_HAS(read.json["runs"][0]["note"].get<std::string>(), "before the press begins at 0.5 s");
}

TEST_F(SweepPageTest, RefusesWhatItCannotShow) {
  EXPECT_HAS(refusal([&] { page({"7,0"}); }), "expected 0..1,0..2");
  SweepResult pending = stored_;
  pending.state[5] = RunState::failed, pending.error[5] = "no memory";
  write(pending);
  EXPECT_HAS(refusal([&] { page({"1,2"}); }), "has no finished run");
  pending.state[5] = RunState::pending;
  write_sweep_in_progress(folder_ / "map.h5", pending, provenance(sweep_.to_json(), "a test", ""));
  EXPECT_HAS(refusal([&] { page({}); }), "is not finished");
}

TEST(PageFile, MakesNoTagOfItsTitleNamesOrTexts) {
  const std::string words = "\"'></script></title><script>alert(1)</script><!--<script>&lt;";
  const Json json = {{"title", words}, {words, {words, {{"deep", words}}}}};
  const std::string html = page_file(words, json.dump(), words), plain = page_file("x", "{}", "x");
  for (const char* tag : {"<script", "</script", "</title", "<!--"})
    EXPECT_EQ(count(html, tag), count(plain, tag)) << tag;
  const ReadPage page(html);
  EXPECT_EQ(page.json, json);
  EXPECT_EQ(page.bytes, words);
}

TEST(Descriptions, OfParametersAndColumns) {
  const std::string text = described("proxy.r1_m");
  EXPECT_TRUE(text.starts_with("proxy.r1_m: a parameter of \"renderer\": ")) << text;
  EXPECT_HAS(text, "\n  unit m; default 0.00499; allowed ");
  EXPECT_HAS(text, "; live\n");
  EXPECT_EQ(std::ranges::count(text, '\n'), 2);
  const std::string all = described("renderer.r1_m");  // of every renderer that has it
  EXPECT_HAS(all, "proxy.r1_m: ");
  EXPECT_HAS(all, "tracked-sheet.r1_m: ");
  EXPECT_EQ(all.find("tool.r1_m"), std::string::npos);
  EXPECT_HAS(described("run.seed"), "run.seed: a parameter of \"run\": ");
  EXPECT_EQ(described("fixtures.0.radius_m"), described("fixtures.radius_m"));
  EXPECT_EQ(described("trace.force"),
            "trace.force: a column of a trace: force of the renderer, world frame\n"
            "  unit N; 3 in each row; in every run\n");
  EXPECT_HAS(described("trace.state"), "0 free, 1 contact, 2 entrenched\n  with a tool: ");
}

TEST(Descriptions, RefuseUnknownNames) {
  const auto refused = [](const char* name) { return refusal([&] { described(name); }); };
  EXPECT_EQ(refused("proxy.r1"), "proxy.r1: unknown; did you mean proxy.r1_m");
  EXPECT_EQ(refused("renderer.stifness_N_per_m"),
            "renderer.stifness_N_per_m: unknown; did you mean renderer.stiffness_N_per_m");
  EXPECT_EQ(refused("trace.forces"), "trace.forces: unknown; did you mean trace.force");
  for (const char* name : {"absent.r1_m", "fig4.12.seed", "proxy.0.1.r1_m", "proxy.", ".seed", ".", ""})
    EXPECT_HAS(refused(name), "expected a name from `remote-touch list`, or NAME.PARAMETER") << name;
  const std::string message = refusal([] { named_kind("robots"); });
  EXPECT_HAS(message, "robots: is not a kind: expected sections, scenarios, fixture rules, ");
  for (const NamedKind& kind : named_kinds()) EXPECT_HAS(message, kind.kind);
}

// A sweep that keeps a tally, for example, has no plan of its runs.
TEST(Descriptions, AreThereOfEverySweepAndFigure) {
  for (const char* kind : {"sweeps", "figures"})
    for (const auto& row : named_kind(kind).rows) EXPECT_HAS(described(row.name), row.name + ": a ");
}

}  // namespace
}  // namespace remote_touch::sweep_page_test
