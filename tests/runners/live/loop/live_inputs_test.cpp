// The recordings that a live run reads.
#include "runners/live/loop/live_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_files.h"

namespace remote_touch::live_inputs_test {
namespace {

using Paths = std::vector<std::string>;

// The scenario, the trajectory and the tool each read a file. None is opened here.
Experiment experiment() {
  return Experiment::from_json(
      R"({"scenario": {"name": "recording", "path": "scene"}, "depth_pipeline": {},
          "renderer": {"name": "tool", "tool_mesh": "ball.obj"},
          "trajectory": {"name": "live-session", "path": "hand.h5"}})",
      "test");
}

Paths paths(const std::string& device, const std::string& depth, bool has_view = false) {
  Paths all;
  for (const RecordingPart& part : live_inputs(experiment(), device, depth, has_view))
    all.push_back(part.path);
  std::sort(all.begin(), all.end());
  return all;
}

TEST(LiveInputs, NameTheSourceOfTheDepth) {
  for (const std::string scheme : {"dir:", "tum:", "pcd:", "replay:"})
    EXPECT_EQ(paths("fd:0", scheme + "seen"), (Paths{"ball.obj", "seen"})) << scheme;
  EXPECT_EQ(paths("fd:0", "sim:"), (Paths{"ball.obj", "scene"}));
  EXPECT_EQ(paths("fd:0", "k4a:0"), Paths{"ball.obj"});
  EXPECT_EQ(paths("fd:0", "oni:any"), Paths{"ball.obj"});
  EXPECT_EQ(paths("fd:0", "oni:seen.oni"), (Paths{"ball.obj", "seen.oni"}));
}

TEST(LiveInputs, NameTheSceneInWhichAHandIsPlanned) {
  for (const char* device : {"sim:", "browser:"})
    EXPECT_EQ(paths(device, "dir:seen"), (Paths{"ball.obj", "hand.h5", "scene", "seen"})) << device;
  EXPECT_EQ(paths("fd:0", "dir:seen", true), (Paths{"ball.obj", "hand.h5", "scene", "seen"}));
  EXPECT_EQ(paths("replay:other.h5", "dir:seen"), (Paths{"ball.obj", "other.h5", "scene", "seen"}));
}

TEST(LiveInputs, RefuseUnknownSchemes) {
  EXPECT_HAS(refusal([] { live_inputs(experiment(), "moon:", "sim:", false); }), "--device moon:");
  EXPECT_HAS(refusal([] { live_inputs(experiment(), "sim:", "moon:", false); }), "--depth moon:");
}

}  // namespace
}  // namespace remote_touch::live_inputs_test
