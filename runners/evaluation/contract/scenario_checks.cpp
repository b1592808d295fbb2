// The contract of every scenario.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "core/geometry/point_cloud.h"
#include "runners/evaluation/contract/checks.h"
#include "runners/evaluation/contract/flat_scene.h"

namespace remote_touch {

namespace {

std::unique_ptr<Scenario> scenario_of(const ScenarioEntry& entry, const FillSettings& fill) {
  return filled(entry, fill)->build(NoiseKey{7}, scenes::kernels());
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

// A result holds the hashes of all files that it was made from.
void files_that_settings_name_are_told(const ScenarioEntry& entry, const FillSettings& fill) {
  const auto factory = filled(entry, fill);
  for (const Parameter& p : factory->settings()) {
    if (p.name != "path") continue;
    ASSERT_EQ(factory->inputs().size(), 1u);
    EXPECT_EQ(factory->inputs()[0].path, *std::get<std::string*>(p.value));
  }
}

void frames_are_pure(const ScenarioEntry& entry, const FillSettings& fill) {
  const auto one = scenario_of(entry, fill), other = scenario_of(entry, fill);
  const int last = std::min(3, one->frame_count() - 1);
  one->cloud(last);  // a query in another order must give the same clouds
  for (const int frame : {0, last}) {
    const PointCloud a = one->cloud(frame), b = other->cloud(frame);
    EXPECT_GT(a.size(), 0u);
    EXPECT_FALSE(is_far_from_origin(a));
    EXPECT_TRUE(same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z));
  }
}

void search_and_cloud_show_the_same_points(const ScenarioEntry& entry, const FillSettings& fill) {
  const auto scenario = scenario_of(entry, fill);
  const PointCloud cloud = scenario->cloud(0);
  const auto points = scenario->points(0);
  EXPECT_EQ(points->size(), cloud.size());
  GatheredPoints found, expected;
  for (GatheredPoints* out : {&found, &expected}) out->reserve(cloud.size(), false, false);
  const BruteForceSearch oracle(cloud);
  for (std::size_t i = 0; i < cloud.size(); i += cloud.size() / 16 + 1) {
    if (!cloud.point(i).allFinite()) continue;
    const Ball ball{cloud.point(i), 0.012};
    found.clear(), expected.clear();
    points->gather(ball, scenes::kernels(), found);
    oracle.gather(ball, scenes::kernels(), expected);
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_GT(found.size(), 0u);
  }
}

void rates_and_times_make_sense(const ScenarioEntry& entry, const FillSettings& fill) {
  const auto scenario = scenario_of(entry, fill);
  EXPECT_GT(scenario->frame_rate_hz(), 0);
  ASSERT_GE(scenario->frame_count(), 1);
  EXPECT_EQ(scenario->captured_s(0), 0);
  for (int j = 1; j < std::min(5, scenario->frame_count()); ++j)
    EXPECT_GT(scenario->captured_s(j), scenario->captured_s(j - 1));
}

void normals_are_one_a_point_and_of_unit_length(const ScenarioEntry& entry, const FillSettings& fill) {
  const PointCloud cloud = scenario_of(entry, fill)->cloud(0);
  if (!cloud.has_normals()) return;  // a scenario need not give any
  ASSERT_TRUE(cloud.nx.size() == cloud.size() && cloud.ny.size() == cloud.size() &&
              cloud.nz.size() == cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) ASSERT_NEAR(cloud.normal(i).norm(), 1, 1e-15);
}

constexpr ContractCheck<ScenarioEntry> kScenarioChecks[] = {
    {"ItsDefaultsAreValid", its_defaults_are_valid},
    {"FilesThatSettingsNameAreTold", files_that_settings_name_are_told},
    {"FramesArePure", frames_are_pure},
    {"SearchAndCloudShowTheSamePoints", search_and_cloud_show_the_same_points},
    {"RatesAndTimesMakeSense", rates_and_times_make_sense},
    {"NormalsAreOneAPointAndOfUnitLength", normals_are_one_a_point_and_of_unit_length},
};

}  // namespace

std::span<const ContractCheck<ScenarioEntry>> scenario_checks() {
  return kScenarioChecks;
}

}  // namespace remote_touch
