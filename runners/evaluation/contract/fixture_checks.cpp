// The contract of every fixture rule.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/geometry/camera.h"
#include "runners/evaluation/contract/checks.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

namespace {

// Returns an image of 8 x 6 pixels of a wall 0.6 m away, each pixel in another colour. The upper left 2 x 2
// pixels measured nothing: their points are NaN.
PointCloud coloured_image() {
  PointCloud cloud;
  cloud.image = ImageLayout{{8, 6, 10, 10, 3.5, 2.5}, RigidTransform::Identity(), 0};
  for (int i = 0; i < 48; ++i) {
    const int row = i / 8;
    const bool seen = i % 8 > 1 || row > 1;
    const double z = seen ? 0.6 : std::numeric_limits<double>::quiet_NaN();
    const Vec3 p = unproject(cloud.image->camera, i % 8, row, z);
    cloud.append(seen ? p : Vec3::Constant(z));
    cloud.colour.push_back(static_cast<std::uint32_t>(i * 349525));
  }
  return cloud;
}

void weights_are_one_a_point_and_from_nothing_to_one(const FixtureEntry& entry, const FillSettings& fill) {
  const PointCloud cloud = coloured_image();
  const std::vector<double> weights = filled(entry, fill)->build()->weights(cloud);
  ASSERT_EQ(weights.size(), cloud.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_TRUE(weights[i] >= 0 && weights[i] <= 1) << i;
    if (!cloud.point(i).allFinite()) {
      EXPECT_EQ(weights[i], 0) << i;
    }
  }
}

void nothing_is_picked_of_a_frame_that_saw_nothing(const FixtureEntry& entry, const FillSettings& fill) {
  PointCloud cloud = coloured_image();
  cloud.x.assign(cloud.size(), std::numeric_limits<double>::quiet_NaN()), cloud.y = cloud.z = cloud.x;
  EXPECT_EQ(filled(entry, fill)->build()->weights(cloud), std::vector<double>(cloud.size()));
}

void weights_are_pure(const FixtureEntry& entry, const FillSettings& fill) {
  const PointCloud cloud = coloured_image();
  PointCloud other = cloud;
  other.x[20] += 1, other.colour[30] = 0;
  const auto one = filled(entry, fill)->build(), fresh = filled(entry, fill)->build();
  const std::vector<double> first = one->weights(cloud);
  one->weights(other);  // an earlier query must not change a later result
  EXPECT_EQ(one->weights(cloud), first);
  EXPECT_EQ(fresh->weights(cloud), first);
}

void gives_the_values_of_its_settings(const FixtureEntry& entry, const FillSettings& fill) {
  const auto made = filled(entry, fill);
  const Json set = {{"radius_m", 0.25}, {"stiffness_N_per_m", 77}, {"schedule", {{1, 0.5}, {2, 0}}}};
  read_parameters(set, made->settings(), entry.name);
  EXPECT_EQ(made->validate(), "");
  const auto rule = made->build();
  EXPECT_EQ(rule->values().radius_m, 0.25);
  EXPECT_EQ(rule->values().stiffness_N_per_m, 77);
  EXPECT_EQ(rule->strength(0), 0.5);
  EXPECT_TRUE(rule->changes_with_time());
  read_parameters({{"schedule", {{1, 0.5}, {0, 0}}}}, made->settings(), entry.name);
  EXPECT_NE(made->validate().find("schedule: time"), std::string::npos) << made->validate();
}

void files_that_a_rule_reads_are_told(const FixtureEntry& entry, const FillSettings& fill) {
  const auto made = filled(entry, fill);
  const std::string* path = nullptr;
  for (const Parameter& p : made->settings())
    if (p.name == "path") path = std::get<std::string*>(p.value);
  ASSERT_EQ(made->inputs().size(), path ? 1u : 0u);
  if (path) {
    EXPECT_EQ(made->inputs()[0].path, *path);
  }
}

void settings_survive_a_round_trip_through_an_experiment(const FixtureEntry& entry,
                                                         const FillSettings& fill) {
  const auto made = filled(entry, fill);
  read_parameters({{"radius_m", 0.1 + 0.2}, {"schedule", {{0, 0.1}, {1e-3, 1}}}}, made->settings(),
                  entry.name);
  Json rule = {{"name", entry.name}};
  write_parameters(made->settings(), rule);
  Json json = Json::parse(Experiment::load("fig4.11").to_json());
  json["fixtures"] = {rule, rule};  // an experiment may contain the same rule twice
  const Experiment experiment = Experiment::from_json(json);
  const std::string text = experiment.to_json();
  EXPECT_EQ(Json::parse(text)["fixtures"], json["fixtures"]);
  EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
  EXPECT_FALSE(experiment.build_fixtures().empty());
}

constexpr ContractCheck<FixtureEntry> kFixtureChecks[] = {
    {"ItsDefaultsAreValid", its_defaults_are_valid},
    {"WeightsAreOneAPointAndFromNothingToOne", weights_are_one_a_point_and_from_nothing_to_one},
    {"NothingIsPickedOfAFrameThatSawNothing", nothing_is_picked_of_a_frame_that_saw_nothing},
    {"WeightsArePure", weights_are_pure},
    {"GivesTheValuesOfItsSettings", gives_the_values_of_its_settings},
    {"FilesThatSettingsNameAreTold", files_that_a_rule_reads_are_told},
    {"SettingsSurviveARoundTripThroughAnExperiment", settings_survive_a_round_trip_through_an_experiment},
};

}  // namespace

std::span<const ContractCheck<FixtureEntry>> fixture_checks() {
  return kFixtureChecks;
}

}  // namespace remote_touch
