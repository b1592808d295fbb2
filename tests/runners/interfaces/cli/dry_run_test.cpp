// The estimate of `sweep --dry-run`.
#include <gtest/gtest.h>

#include "core/kernels/kernels.h"
#include "runners/interfaces/cli/program.h"
#include "tests/support/test_files.h"

namespace remote_touch::dry_run_test {
namespace {

// A run takes a millisecond.
constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 2}],
  "replicates": 2, "measures": ["max_penetration"]})";

std::string printed(const CommandLine& line, const SweepRequest& request) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(command_sweep(line, request), kDone);
  return testing::internal::GetCapturedStdout();
}

TEST(DryRun, HasNoTimeToEstimateIfNoRunIsLeft) {
  const TestFolder folder("dry_run");
  CommandLine line;
  line.quiet = true;
  line.kernels = &kernels_for(best_isa());
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string();
  request.output = (folder / "map.h5").string(), request.shard = "1/1", request.dry_run = true;
  EXPECT_HAS(printed(line, request), " in the 4 that were tried)\n");
  request.dry_run = false;
  printed(line, request);
  request.dry_run = true;
  const std::string done = printed(line, request);
  EXPECT_HAS(done, "0 runs to do, all valid; 4 are done\n  no time to estimate: no run was tried\n");
  EXPECT_EQ(done.find("about"), std::string::npos) << done;
}

TEST(DryRun, RefusesATallyThatTheSweepWouldRefuse) {
  const TestFolder folder("dry_run");
  CommandLine line;
  line.quiet = true;
  line.kernels = &kernels_for(best_isa());
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string(), request.dry_run = true;
  request.overrides = {"keep=tally"};
  EXPECT_HAS(printed(line, request), "4 runs to do, all valid\n");
  request.overrides.emplace_back(
      R"(axes=[{"parameter": "seed", "from": 0, "to": 1000, "count": 1001},
               {"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 1000}])");
  EXPECT_HAS(refusal([&] { command_sweep(line, request); }), "has 1001000 cells: expected 1 to 1000000");
}

// Each run is tried once if there are fewer than it would try.
TEST(DryRun, TriesEachOfFewRuns) {
  const TestFolder folder("dry_run");
  CommandLine line;
  line.quiet = true;
  line.kernels = &kernels_for(best_isa());
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string(), request.dry_run = true;
  request.overrides = {"duration_s=0.01"};
  EXPECT_HAS(printed(line, request), "note on the runs that were tried: 4 of 4 runs: no contact");
}

// A dry run reads the file as the sweep does.
TEST(DryRun, KnowsWhatATallyHas) {
  const TestFolder folder("dry_run");
  CommandLine line;
  line.quiet = true;
  line.kernels = &kernels_for(best_isa());
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string(), request.overrides = {"keep=tally"};
  request.output = (folder / "tally.h5").string();
  printed(line, request);
  request.dry_run = true;
  EXPECT_HAS(printed(line, request), "0 runs to do, all valid; 4 are done\n  no time to estimate");
  request.overrides.emplace_back("replicates=3");
  EXPECT_HAS(refusal([&] { command_sweep(line, request); }), "tally.h5: is of another configuration");
}

}  // namespace
}  // namespace remote_touch::dry_run_test
