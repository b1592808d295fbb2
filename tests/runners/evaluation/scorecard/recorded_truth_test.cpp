// A scene of the scorecard whose recording has a truth: the card judges by it and states it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "core/kernels/kernels.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "scenarios/files/input_files.h"
#include "tests/support/recorded_wall.h"

namespace remote_touch::scorecard_truth_test {
namespace {

// Two scenes of the same recording. The measured wall is 1.4 mm in front of the true one, and the surface is
// held if the contact point is at most 1 mm from it.
class ScorecardTruth : public testing::Test {
 protected:
  BenchmarkScene scene(const std::string& name, const std::string& more) const {
    return read_benchmark_scene(name, R"({"title": "a wall", "experiment": {"scenario": )" +
                                          recorded_wall::scenario(wall_, more) + R"(, "trajectory": )" +
                                          recorded_wall::kPress + R"(, "duration_s": 0.4},
        "measures": {"rms_renderer_error": "reported", "rms_camera_error": "reported"},
        "success": {"rule": "held", "tolerance_m": 0.001}})");
  }
  ScorecardReport report() const {
    const BenchmarkPlan plan =
        plan_of({chosen_methods({"god-object"}),
                 {scene("by-the-mesh", ""), scene("by-the-camera", R"(, "truth": "measured")")},
                 2,
                 folder_ / "card"});
    make_scorecard_folder(plan.benchmark.folder);
    const Kernels& kernels = kernels_for(best_isa());
    do_sweeps(plan.sweeps(), kernels, nullptr, [](auto...) {});
    return evaluate(plan, kernels, nullptr, [](auto...) {});
  }
  const TestFolder folder_{"scorecard_truth_test"};
  const std::string wall_ = recorded_wall::write(folder_);
};

TEST_F(ScorecardTruth, JudgesByTheMeshesOfTheRecording) {
  const ScorecardReport card = report();
  const auto& scenes = card.card.scenes;
  EXPECT_EQ(scenes.at(0).success.at(0).noisy.events, 0) << "the camera's error counts";
  EXPECT_EQ(scenes.at(1).success.at(0).noisy.events, scenes.at(1).success.at(0).noisy.runs);
  EXPECT_GT(scenes.at(1).success.at(0).noisy.runs, 0);
}

TEST_F(ScorecardTruth, IsStatedBesideEachRecordedScene) {
  const Json card = parse_json(to_json(report()), "scorecard.json");
  EXPECT_EQ(card["scenes"][0]["truth"], "meshes of truth/ (wall), uncertainty 3 mm");
  EXPECT_EQ(card["scenes"][1]["truth"], "the measured surface");
}

}  // namespace
}  // namespace remote_touch::scorecard_truth_test
