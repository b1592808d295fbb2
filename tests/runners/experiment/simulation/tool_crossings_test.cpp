// Audits every tick of the experiments with a tool for points that got into it between two frames. The ticks
// in which a frame comes are left out, because its points can be anywhere.
#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/recordings/recording.h"
#include "tests/runners/experiment/simulation/tool_audit.h"
#include "tests/support/recorded_data.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"
#include "tests/support/test_name.h"

namespace remote_touch::tool_crossings_test {
namespace {

// A point less deep than this is no collision for the look-ahead rule (look_ahead_motion.h).
constexpr double kLookAhead_m = 1e-4;
constexpr double kContinuous_m = 1e-5;
// The printed rule lets points into the shell: a point of it is within 1.5 sqrt(3) voxels of the centre of a
// free voxel, which is outside.
constexpr double kVoxels_m = 2.5981 * 5e-4;

ToolPose pose_at(const Trace& trace, std::size_t tick) {
  return {trace.proxy_position_m[tick], trace.tool_orientation[tick]};
}

// The treatment of the ticks in which a frame comes.
enum class Frames { left_out, followed };

ToolAudit audited(const Trace& trace, const std::map<int, PointCloud>& clouds, ToolAuditor auditor,
                  Frames frames) {
  int shown = -1;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (trace.frame_index[i] == shown) {
      auditor.tick(pose_at(trace, i - 1), pose_at(trace, i));
      continue;
    }
    const bool is_first = shown < 0;
    shown = trace.frame_index[i];
    if (is_first || frames == Frames::left_out)
      auditor.on_frame(clouds.at(shown));
    else
      auditor.tick_with_frame(clouds.at(shown), pose_at(trace, i - 1), pose_at(trace, i));
  }
  return auditor.audit();
}

ToolAudit audited(const std::string& name, const std::string& rule, double tolerance_m,
                  std::vector<std::string> overrides = {}, Frames frames = Frames::left_out) {
  overrides.push_back("renderer.contact_rule=" + rule);
  const Experiment experiment = Experiment::load(name, overrides);
  std::map<int, PointCloud> clouds;
  SimulationOptions options;
  options.on_frame = [&](const Frame& frame) {
    PointCloud buffer;
    clouds[frame.index] = frame.points->every_point(scenes::kernels(), buffer);
  };
  const Trace trace = simulate(experiment, options);
  const ToolAudit audit = audited(trace, clouds, {tool_of(experiment)->mesh, tolerance_m}, frames);
  std::printf("%s, %s: of %lld point-ticks %lld entered the tool by more than %g mm\n", name.c_str(),
              rule.c_str(), static_cast<long long>(audit.point_ticks), static_cast<long long>(audit.entered),
              1e3 * tolerance_m);
  return audit;
}

class ToolCrossings : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Experiments, ToolCrossings, testing::Values("fig6.3", "tool-slab", "tool-slot"),
                         [](const auto& experiment) { return test_name(experiment.param); });
// Only scripts/test --evidence runs it.
INSTANTIATE_TEST_SUITE_P(LongExperiments, ToolCrossings,
                         testing::Values("tool-walk", "fig6.4", "fig6.4-organ", "fig6.4-box"),
                         [](const auto& experiment) { return test_name(experiment.param); });

void expect_none(const std::string& name, const std::string& rule, double tolerance_m) {
  set_data_folder(data_root().string());
  try {
    const ToolAudit audit = audited(name, rule, tolerance_m);
    EXPECT_GT(audit.point_ticks, 1'000'000);
    EXPECT_EQ(audit.entered, 0) << audit.deepest_m;
  } catch (const InputError& missing) {
    ASSERT_TRUE(contains(missing.what(), "no such recording")) << missing.what();
    GTEST_SKIP() << missing.what();
  }
}

TEST_P(ToolCrossings, ThereAreNone) {
  for (const auto& [rule, tolerance_m] :
       {std::pair("look-ahead", kLookAhead_m), {"continuous", kContinuous_m}, {"voxels", kVoxels_m}}) {
    SCOPED_TRACE(rule);
    expect_none(GetParam(), rule, tolerance_m);
  }
}

// Points are so dense here that one disk stands for many. Each motion is still checked against every point.
TEST(ToolCrossings, ThereAreNoneWherePointsAreMerged) {
  const ToolAudit audit = audited("fig6.3", "continuous", kContinuous_m, {"scenario.spacing_m=0.0005"});
  EXPECT_GT(audit.point_ticks, 10'000'000);
  EXPECT_EQ(audit.entered, 0) << audit.deepest_m;
}

// The tool comes from the back of a surface. The printed rule pulls it through.
TEST(ToolCrossings, VoxelsPullAToolThroughFromTheBack) {
  EXPECT_EQ(audited("tool-sheet", "look-ahead", kLookAhead_m).entered, 0);
  EXPECT_EQ(audited("tool-sheet", "continuous", kContinuous_m).entered, 0);
  EXPECT_GT(audited("tool-sheet", "voxels", kVoxels_m).entered, 0);
}

// Points are followed through frames, too, because the position of each point in the frame before is known. A
// surface that rises by more than the plate's thickness in every frame carries the plate along and does not
// pass through it.
TEST(ToolCrossings, ThereAreNoneAtFramesByTheContinuousRuleWhereASurfaceRises) {
  for (const char* surface : {"scenario.shape=flat", "scenario.tilt_deg=30", "scenario.tilt_deg=-45"}) {
    const auto entered = [&](const std::string& rule) {
      return audited("tool-lift", rule, kContinuous_m,
                     {"renderer.tool_mesh=slab-5", "scenario.start_velocity_m_per_s=0.24",
                      "scenario.rise_s=0.13333333333333333", "duration_s=0.65", surface},
                     Frames::followed)
          .entered;
    };
    EXPECT_EQ(entered("continuous"), 0) << surface;
    EXPECT_GT(entered("look-ahead"), 10) << surface;
  }
}

// Walls that close to less than the tool's thickness: no pose keeps their points out.
TEST(ToolCrossings, TheContinuousRuleMovesIntoNoPointsBetweenClosingWalls) {
  EXPECT_EQ(audited("tool-wedge", "continuous", kContinuous_m).entered, 0);
  EXPECT_GT(audited("tool-wedge", "look-ahead", kLookAhead_m).entered, 0);
  EXPECT_GT(audited("tool-wedge", "voxels", kVoxels_m).entered, 0);
}

}  // namespace
}  // namespace remote_touch::tool_crossings_test
