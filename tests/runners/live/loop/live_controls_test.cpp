// Changes of parameters on their way to the haptic loop.
#include "runners/live/loop/live_controls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_controls_test {
namespace {

Experiment experiment(const std::vector<std::string>& overrides = {}) {
  return Experiment::from_json(R"({
      "scenario": {"name": "camera-scene", "width": 64, "height": 48}, "renderer": {"name": "proxy"},
      "trajectory": {"name": "waypoints"}})",
                               "test", overrides);
}

class LiveControlsTest : public testing::Test {
 protected:
  std::int32_t number(const std::string& name) const {
    const auto& all = controls_.parameters();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) return static_cast<std::int32_t>(i);
    ADD_FAILURE() << name << " is not live";
    return 0;
  }
  std::string change(const std::vector<std::pair<std::string, double>>& values) {
    ParameterChanges changes;
    for (const auto& [name, value] : values) changes.list[changes.count++] = {number(name), value};
    return controls_.change(changes);
  }
  double value(const std::string& name) const {
    return controls_.values()[static_cast<std::size_t>(number(name))];
  }

  LiveControls controls_{experiment(), scenes::kernels(), LiveControls::Camera::simulated};
};

TEST_F(LiveControlsTest, ListsTheRenderersAndThenTheScenarios) {
  std::vector<std::string> names;
  for (const LiveParameter& parameter : controls_.parameters()) names.push_back(parameter.name);
  EXPECT_EQ(names, (std::vector<std::string>{"renderer.r1_m", "renderer.r2_m", "renderer.r3_m",
                                             "renderer.stiffness_N_per_m", "renderer.velocity_estimate",
                                             "scenario.noise_per_m"}));
  const LiveParameter& on = controls_.parameters()[4];
  EXPECT_TRUE(on.is_switch);
  EXPECT_EQ(on.value, 1);
  EXPECT_EQ(on.high, 1);
}

TEST_F(LiveControlsTest, ScenarioIsNotShownIfThereIsAnotherCamera) {
  const LiveControls controls(experiment(), scenes::kernels(), LiveControls::Camera::other);
  EXPECT_EQ(controls.parameters().size(), 5u);
  EXPECT_EQ(controls.scenario(), nullptr);
}

TEST_F(LiveControlsTest, AllowedChangesAreHandedToTheLoop) {
  EXPECT_EQ(controls_.requested().oldest(), nullptr);
  EXPECT_EQ(change({{"renderer.r1_m", 0.00699}, {"renderer.r2_m", 0.00701}}), "");
  const ParameterChanges* const requested = controls_.requested().oldest();
  ASSERT_NE(requested, nullptr);
  ASSERT_EQ(requested->count, 2u);
  EXPECT_EQ(requested->list[1].parameter, 1);
  EXPECT_EQ(requested->list[1].value, 0.00701);
  EXPECT_EQ(value("renderer.r1_m"), 0.00699);
}

TEST_F(LiveControlsTest, OtherChangesAreRefusedWithTheReasonAndChangeNothing) {
  EXPECT_EQ(change({{"renderer.r1_m", 0.2}}), "renderer.r1_m = 0.2: expected below r2_m = 0.00501");
  EXPECT_EQ(value("renderer.r1_m"), 0.00499);
  for (const double wrong : {-1.0, 1e5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_HAS(change({{"renderer.stiffness_N_per_m", wrong}}), "renderer.stiffness_N_per_m") << wrong;
  EXPECT_HAS(change({{"renderer.velocity_estimate", 0.5}}), "renderer.velocity_estimate");
  ParameterChanges none;
  none.list[0] = {6, 1}, none.count = 1;
  EXPECT_EQ(controls_.change(none), "there is no live parameter 6");
  none.list[0].parameter = -1;
  EXPECT_EQ(controls_.change(none), "there is no live parameter -1");
  EXPECT_EQ(controls_.requested().oldest(), nullptr);
}

// Each change is checked together with those before it.
TEST_F(LiveControlsTest, ChangesAddUp) {
  EXPECT_EQ(change({{"renderer.r3_m", 0.03}}), "");
  EXPECT_EQ(change({{"renderer.r2_m", 0.02}}), "");
  EXPECT_EQ(change({{"renderer.r1_m", 0.0199}}), "");
  EXPECT_EQ(change({{"renderer.r3_m", 0.01}}), "renderer.r2_m = 0.02: expected below r3_m = 0.01");
  EXPECT_EQ(change({{"renderer.velocity_estimate", 0}}), "");
}

TEST_F(LiveControlsTest, ChangesAreLimitedIfTheLoopDoesNotReadThem) {
  int taken = 0;
  while (taken < 1000 && change({{"renderer.r3_m", 0.01 + 1e-5 * taken}}).empty()) ++taken;
  EXPECT_EQ(taken, 64);
  EXPECT_HAS(change({{"renderer.r3_m", 0.02}}), "not yet applied");
  EXPECT_NE(value("renderer.r3_m"), 0.02);
}

TEST_F(LiveControlsTest, StiffnessOfASoftDeviceDoesNotGrow) {
  controls_.limit_stiffness();
  EXPECT_EQ(change({{"renderer.stiffness_N_per_m", 300}}), "");
  EXPECT_EQ(change({{"renderer.stiffness_N_per_m", 600}}), "");
  EXPECT_HAS(change({{"renderer.stiffness_N_per_m", 601}}), "no greater stiffness");
}

// The scenario's frames are those of the experiment with that noise.
TEST_F(LiveControlsTest, NoiseIsThatOfTheNextFrame) {
  const auto scenario = controls_.scenario();
  const auto noisy = experiment({"scenario.noise_per_m=0.02"}).build_scenario(scenes::kernels());
  EXPECT_NE(scenario->cloud(3).z, noisy->cloud(3).z);
  EXPECT_EQ(change({{"scenario.noise_per_m", 0.02}}), "");
  EXPECT_EQ(scenario->cloud(3).z, noisy->cloud(3).z);
  EXPECT_EQ(scenario->cloud(3).y, noisy->cloud(3).y);
}

// A scenario without noise has one frame, which is repeated. A camera may still request a later one.
TEST_F(LiveControlsTest, NoiseCanBeSwitchedOffAndOnAgain) {
  const auto scenario = controls_.scenario();
  const PointCloud before = scenario->cloud(40);
  EXPECT_EQ(change({{"scenario.noise_per_m", 0}}), "");
  const PointCloud clean = scenario->cloud(40);
  EXPECT_EQ(clean.z, scenario->cloud(41).z);
  EXPECT_NE(clean.z, before.z);
  EXPECT_EQ(change({{"scenario.noise_per_m", controls_.parameters()[5].value}}), "");
  EXPECT_EQ(scenario->cloud(40).z, before.z);
}

TEST_F(LiveControlsTest, AnExperimentWithChangesOfItsOwnHasNone) {
  const LiveControls controls(
      experiment({R"(changes=[{"time_s": 1, "parameter": "renderer.r3_m", "value": 0.02}])"}),
      scenes::kernels(), LiveControls::Camera::simulated);
  EXPECT_TRUE(controls.parameters().empty());
}

}  // namespace
}  // namespace remote_touch::live_controls_test
