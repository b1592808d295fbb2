// The contract of every entry of the catalog. A new scenario, fixture rule or trajectory is tested here
// from its birth, a renderer in renderer_contract_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/cloud/camera.h"
#include "runners/experiment/catalog.h"
#include "runners/experiment/experiment.h"
#include "runners/figures/figures.h"
#include "runners/sessions/session_file.h"
#include "runners/settings/json_parameters.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::contract_test {
namespace {

// A live session of two frames and some ticks, as entries called live-session need one.
std::string write_session(const TestFolder& folder) {
  const std::string file = (folder / "session.h5").string();
  const SensorView view{{64, 2, 60, 60, 31.5, 0.5}, 0.001, 30, false, RigidTransform::Identity()};
  SessionWriter session(file, view, RigidTransform::Identity(), {{"config", R"({"haptic_rate_hz": 1000})"}});
  SensorFrame frame;
  frame.depth.assign(128, 500);
  for (int i = 0; i < 2; ++i) {
    frame.number = i, frame.depth[5] = static_cast<std::uint16_t>(480 + i);
    session.append(frame, i / 30.0, 0);
  }
  SessionTick tick;
  for (int i = 0; i < 100; ++i) {
    tick.number = i + 3, tick.taken = i % 50 == 0 ? i / 50 : -1;
    tick.device.position_W = Vec3(0.001 * i, 0, 0.5);
    session.append(tick);
  }
  session.finish();
  return file;
}

// The blueprint of an entry with its defaults; those that read a file get one that is made here.
template <class Entry>
auto with_a_file(const Entry& entry, const TestFolder& folder) {
  auto factory = entry.make();
  for (const Parameter& p : factory->settings())
    if (p.name == "path")
      *std::get<std::string*>(p.value) =
          std::string(entry.name) == "live-session" ? write_session(folder) : folder.path().string();
  return factory;
}

// --- scenarios ---

class ScenarioContract : public testing::Test {
 protected:
  ScenarioContract() {
    folder_.write_depth("depth/0000.png", 500, 64);
    folder_.write_depth("depth/0001.png", 520, 64);
    folder_.write(
        "camera.json",
        R"({"width": 64, "height": 2, "fx": 60, "fy": 60, "cx": 31.5, "cy": 0.5, "depth_scale_m": 0.001,
                      "frame_rate_hz": 30})");
  }

  std::unique_ptr<Scenario> build(const ScenarioEntry& entry) const {
    return with_a_file(entry, folder_)->build(NoiseKey{7}, scenes::kernels());
  }

  TestFolder folder_{"contract"};
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// A result is to hold the hashes of all files that it was made from.
TEST_F(ScenarioContract, FilesThatSettingsNameAreTold) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto factory = entry.make();
    for (const Parameter& p : factory->settings()) {
      if (p.name != "path") continue;
      *std::get<std::string*>(p.value) = folder_.path().string();
      ASSERT_EQ(factory->inputs().size(), 1u) << entry.name;
      EXPECT_EQ(factory->inputs()[0].path, folder_.path()) << entry.name;
    }
  }
}

TEST_F(ScenarioContract, FramesArePure) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto one = build(entry), other = build(entry);
    const int last = std::min(3, one->frame_count() - 1);
    one->cloud(last);  // asked in another order, it answers the same
    for (const int frame : {0, last}) {
      const PointCloud a = one->cloud(frame), b = other->cloud(frame);
      EXPECT_GT(a.size(), 0u) << entry.name;
      EXPECT_TRUE(same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z)) << entry.name;
    }
  }
}

TEST_F(ScenarioContract, SearchAndCloudShowTheSamePoints) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto scenario = build(entry);
    const PointCloud cloud = scenario->cloud(0);
    const auto points = scenario->points(0);
    EXPECT_EQ(points->size(), cloud.size()) << entry.name;
    GatheredPoints found, expected;
    for (GatheredPoints* out : {&found, &expected}) out->reserve(cloud.size(), false, false);
    const BruteForceSearch oracle(cloud);
    for (std::size_t i = 0; i < cloud.size(); i += cloud.size() / 16 + 1) {
      if (!cloud.point(i).allFinite()) continue;
      const Ball ball{cloud.point(i), 0.012};
      found.clear(), expected.clear();
      points->gather(ball, scenes::kernels(), found);
      oracle.gather(ball, scenes::kernels(), expected);
      EXPECT_EQ(found.size(), expected.size()) << entry.name;
      EXPECT_GT(found.size(), 0u) << entry.name;
    }
  }
}

TEST_F(ScenarioContract, RatesAndTimesMakeSense) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto scenario = build(entry);
    EXPECT_GT(scenario->frame_rate_hz(), 0) << entry.name;
    ASSERT_GE(scenario->frame_count(), 1) << entry.name;
    EXPECT_EQ(scenario->captured_s(0), 0) << entry.name;
    for (int j = 1; j < std::min(5, scenario->frame_count()); ++j)
      EXPECT_GT(scenario->captured_s(j), scenario->captured_s(j - 1)) << entry.name;
  }
}

TEST_F(ScenarioContract, OtherSeedsGiveOtherNoise) {
  for (const char* name : {"moving-lift", "camera-scene", "beating-heart", "valve-tank"}) {
    const auto entry = find_entry(scenarios(), name, "scenario");
    const PointCloud a = entry.make()->build(NoiseKey{1}, scenes::kernels())->cloud(0);
    const PointCloud b = entry.make()->build(NoiseKey{2}, scenes::kernels())->cloud(0);
    EXPECT_FALSE(same_bits(a.y, b.y)) << name;
  }
}

TEST_F(ScenarioContract, NormalsAreOneAPointAndOfUnitLength) {
  for (const ScenarioEntry& entry : scenarios()) {
    const PointCloud cloud = build(entry)->cloud(0);
    if (!cloud.has_normals()) continue;
    ASSERT_TRUE(cloud.nx.size() == cloud.size() && cloud.ny.size() == cloud.size() &&
                cloud.nz.size() == cloud.size())
        << entry.name;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      ASSERT_NEAR(cloud.normal(i).norm(), 1, 1e-15) << entry.name;
  }
}

// --- fixture rules ---

class FixtureContract : public testing::Test {
 protected:
  // A wall 0.6 m away in 8 x 6 pixels, of all colours, the upper left of which saw nothing.
  static PointCloud coloured_image() {
    PointCloud cloud;
    cloud.image = ImageLayout{{8, 6, 10, 10, 3.5, 2.5}, RigidTransform::Identity(), 0};
    for (int i = 0; i < 48; ++i) {
      const bool seen = i % 8 > 1 || i / 8 > 1;
      const double z = seen ? 0.6 : std::numeric_limits<double>::quiet_NaN();
      const Vec3 p = unproject(cloud.image->camera, i % 8, i / 8, z);
      cloud.append(seen ? p : Vec3::Constant(z));
      cloud.colour.push_back(static_cast<std::uint32_t>(i * 349525));
    }
    return cloud;
  }

  FixtureContract() {
    std::vector<std::uint8_t> grey(48);
    for (std::size_t i = 0; i < 48; ++i) grey[i] = static_cast<std::uint8_t>(i % 2 * 255);
    mask_ = folder_.write_png("mask.png", 8, 6, PNG_FORMAT_GRAY, grey.data()).string();
  }

  // With the defaults of the catalog; a mask is one that is made here.
  auto factory(const FixtureEntry& entry) const {
    auto made = entry.make();
    for (const Parameter& p : made->settings())
      if (p.name == "path") *std::get<std::string*>(p.value) = mask_;
    return made;
  }

  TestFolder folder_{"fixture_contract"};
  std::string mask_;
};

TEST_F(FixtureContract, SharesAreOneAPointAndFromNothingToOne) {
  for (const FixtureEntry& entry : fixtures()) {
    const PointCloud cloud = coloured_image();
    const std::vector<double> weights = factory(entry)->build()->weights(cloud);
    ASSERT_EQ(weights.size(), cloud.size()) << entry.name;
    double sum = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_TRUE(weights[i] >= 0 && weights[i] <= 1) << entry.name << " " << i;
      if (!cloud.point(i).allFinite()) {
        EXPECT_EQ(weights[i], 0) << entry.name << " " << i;
      }
      sum += weights[i];
    }
    // The wall is too far away from the point that near-point has by default.
    EXPECT_EQ(sum > 0, entry.name != std::string("near-point")) << entry.name;
  }
}

TEST_F(FixtureContract, NothingIsPickedOfAFrameThatSawNothing) {
  for (const FixtureEntry& entry : fixtures()) {
    PointCloud cloud = coloured_image();
    cloud.x.assign(cloud.size(), std::numeric_limits<double>::quiet_NaN()), cloud.y = cloud.z = cloud.x;
    EXPECT_EQ(factory(entry)->build()->weights(cloud), std::vector<double>(cloud.size())) << entry.name;
  }
}

TEST_F(FixtureContract, SharesArePure) {
  for (const FixtureEntry& entry : fixtures()) {
    const PointCloud cloud = coloured_image();
    PointCloud other = cloud;
    other.x[20] += 1, other.colour[30] = 0;
    const auto one = factory(entry)->build(), fresh = factory(entry)->build();
    const std::vector<double> first = one->weights(cloud);
    one->weights(other);  // what it was asked before changes nothing
    EXPECT_TRUE(same_bits(one->weights(cloud), first)) << entry.name;
    EXPECT_TRUE(same_bits(fresh->weights(cloud), first)) << entry.name;
  }
}

TEST_F(FixtureContract, GivesTheValuesOfItsSettings) {
  for (const FixtureEntry& entry : fixtures()) {
    const auto made = factory(entry);
    const Json set = {{"radius_m", 0.25}, {"stiffness_N_per_m", 77}, {"schedule", {{1, 0.5}, {2, 0}}}};
    read_parameters(set, made->settings(), entry.name);
    EXPECT_EQ(made->validate(), "") << entry.name;
    const auto rule = made->build();
    EXPECT_EQ(rule->values().radius_m, 0.25) << entry.name;
    EXPECT_EQ(rule->values().stiffness_N_per_m, 77) << entry.name;
    EXPECT_EQ(rule->strength(0), 0.5) << entry.name;
    EXPECT_TRUE(rule->changes_with_time()) << entry.name;
    read_parameters({{"schedule", {{1, 0.5}, {0, 0}}}}, made->settings(), entry.name);
    EXPECT_HAS(made->validate(), "schedule: time") << entry.name;
  }
}

TEST_F(FixtureContract, FilesThatSettingsNameAreTold) {
  for (const FixtureEntry& entry : fixtures()) {
    const auto made = factory(entry);
    const auto settings = made->settings();
    const bool has_path =
        std::any_of(settings.begin(), settings.end(), [](const Parameter& p) { return p.name == "path"; });
    ASSERT_EQ(made->inputs().size(), has_path ? 1u : 0u) << entry.name;
    if (has_path) {
      EXPECT_EQ(made->inputs()[0].path, mask_) << entry.name;
    }
  }
}

TEST_F(FixtureContract, SettingsSurviveARoundTripThroughAnExperiment) {
  Json rules = Json::array();
  for (const FixtureEntry& entry : fixtures()) {
    const auto made = factory(entry);
    read_parameters({{"radius_m", 0.1 + 0.2}, {"schedule", {{0, 0.1}, {1e-3, 1}}}}, made->settings(),
                    entry.name);
    rules.push_back({{"name", entry.name}});
    write_parameters(made->settings(), rules.back());
  }
  rules.push_back(rules.front());  // a rule may come twice
  Json json = Json::parse(Experiment::load("fig4.11").to_json());
  json["fixtures"] = rules;
  const Experiment experiment = Experiment::from_json(json);
  const std::string text = experiment.to_json();
  EXPECT_EQ(Json::parse(text)["fixtures"], rules);
  EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
  EXPECT_FALSE(experiment.build_fixtures().empty());
}

// --- trajectories ---

TEST(TrajectoryContract, PureFiniteAndAtRestAfterTheEnd) {
  for (const TrajectoryEntry& entry : trajectories()) {
    // The camera's scene has a surface height and an image: enough for every trajectory.
    const auto scene =
        find_entry(scenarios(), "camera-scene", "scenario").make()->build(NoiseKey{1}, scenes::kernels());
    const TestFolder folder("contract");
    const auto factory = with_a_file(entry, folder);
    const auto one = factory->build(*scene), other = factory->build(*scene);
    for (int i = 0; i < 200; ++i) {
      const double time = 0.01 * ((i * 37) % 200);
      EXPECT_TRUE(one->at(time).position_W.allFinite()) << entry.name;
      EXPECT_EQ(one->at(time).position_W, other->at(time).position_W) << entry.name;
      EXPECT_EQ(one->at(time).orientation_W.coeffs(), other->at(time).orientation_W.coeffs()) << entry.name;
      EXPECT_NEAR(one->at(time).orientation_W.norm(), 1, 4e-16) << entry.name;
    }
    const double end = one->duration_s();
    EXPECT_GE(end, 0) << entry.name;
    if (end == 0) continue;
    EXPECT_EQ(one->at(end).position_W, one->at(end + 5).position_W) << entry.name;
    EXPECT_EQ(one->at(end).orientation_W.coeffs(), one->at(end + 5).orientation_W.coeffs()) << entry.name;
  }
}

// --- the tables themselves ---

TEST(Catalog, EveryStoredExperimentCanBeReadAndIsCompleteWhenWritten) {
  ASSERT_FALSE(embedded_experiments().empty());
  for (const EmbeddedText& stored : embedded_experiments()) {
    const Experiment experiment = Experiment::load(stored.name);
    EXPECT_FALSE(experiment.settings().title.empty()) << stored.name;
    const std::string resolved = experiment.to_json();
    EXPECT_EQ(Experiment::from_json(resolved, stored.name).to_json(), resolved) << stored.name;
  }
}

TEST(Catalog, NamesAreUniqueAndDescribed) {
  const auto check = [](const auto& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      EXPECT_GT(std::string(entries[i].summary).size(), 10u) << entries[i].name;
      for (std::size_t j = 0; j < i; ++j) EXPECT_STRNE(entries[i].name, entries[j].name);
    }
  };
  check(scenarios()), check(fixtures()), check(renderers()), check(trajectories()), check(figures());
}

}  // namespace
}  // namespace remote_touch::contract_test
