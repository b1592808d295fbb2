#include "runners/presentation/view/sweep_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/presentation/view/viewer_files.h"
#include "runners/sweep/sweep_run.h"
#include "tests/runners/presentation/view/read_page.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_page_test {
namespace {

constexpr const char* kSweep = R"({"title": "few lifts", "experiment": "fig4.12", "set": {"duration_s": 0.7},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.003, "count": 2},
           {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 20, "count": 3}],
  "measures": ["popped_through", "max_penetration"]})";

class SweepPageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (viewer_script().empty()) GTEST_SKIP() << "built without the viewer";
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

TEST_F(SweepPageTest, ShowsFailuresWhereNoneAreNamed) {
  const auto failed = stored_.measure("popped_through");
  const ReadPage read = page({});
  ASSERT_FALSE(read.json["sweep"]["runs"].empty());
  for (const std::size_t run : read.json["sweep"]["runs"]) EXPECT_EQ(failed[run], 1) << run;
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

}  // namespace
}  // namespace remote_touch::sweep_page_test
