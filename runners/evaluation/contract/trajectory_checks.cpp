// The contract of every scripted hand.
#include <gtest/gtest.h>

#include "core/geometry/point_cloud.h"
#include "runners/evaluation/contract/checks.h"
#include "runners/evaluation/contract/flat_scene.h"

namespace remote_touch {

namespace {

// The camera's scene has a surface height and an image: enough for every trajectory.
std::unique_ptr<Scenario> scene_for_hands() {
  return find_entry(scenarios(), "camera-scene", "scenario").make()->build(NoiseKey{1}, scenes::kernels());
}

void poses_are_pure_and_finite(const TrajectoryEntry& entry, const FillSettings& fill) {
  const auto scene = scene_for_hands();
  const auto factory = filled(entry, fill);
  const auto one = factory->build(*scene), other = factory->build(*scene);
  for (int i = 0; i < 200; ++i) {
    const double time_s = 0.01 * ((i * 37) % 200);  // queries in any order must give the same poses
    EXPECT_TRUE(one->at(time_s).position_W.allFinite());
    EXPECT_TRUE(is_near_origin(one->at(time_s).position_W));
    EXPECT_EQ(one->at(time_s).position_W, other->at(time_s).position_W);
    EXPECT_EQ(one->at(time_s).orientation_W.coeffs(), other->at(time_s).orientation_W.coeffs());
    EXPECT_NEAR(one->at(time_s).orientation_W.norm(), 1, 4e-16);
  }
}

void is_at_rest_after_the_end(const TrajectoryEntry& entry, const FillSettings& fill) {
  const auto scene = scene_for_hands();
  const auto hand = filled(entry, fill)->build(*scene);
  const double end_s = hand->duration_s();
  EXPECT_GE(end_s, 0);
  if (end_s == 0) return;  // it has no end
  EXPECT_EQ(hand->at(end_s).position_W, hand->at(end_s + 5).position_W);
  EXPECT_EQ(hand->at(end_s).orientation_W.coeffs(), hand->at(end_s + 5).orientation_W.coeffs());
}

constexpr ContractCheck<TrajectoryEntry> kTrajectoryChecks[] = {
    {"ItsDefaultsAreValid", its_defaults_are_valid},
    {"PosesArePureAndFinite", poses_are_pure_and_finite},
    {"IsAtRestAfterTheEnd", is_at_rest_after_the_end},
};

}  // namespace

std::span<const ContractCheck<TrajectoryEntry>> trajectory_checks() {
  return kTrajectoryChecks;
}

}  // namespace remote_touch
