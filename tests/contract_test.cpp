// What every entry of the catalog owes its seam. A new scenario, fixture rule, trajectory or renderer is
// tested here from its birth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/camera.h"
#include "runners/catalog.h"
#include "runners/experiment.h"
#include "runners/figures/figures.h"
#include "runners/json_parameters.h"
#include "tests/allocation_counter.h"
#include "tests/scenes.h"
#include "tests/test_files.h"

namespace remote_touch {
namespace {

// --- renderers ---

std::unique_ptr<Renderer> build(const RendererEntry& entry) {
  return entry.make()->build(1000, scenes::kernels());
}

// A flat cloud that holds the renderer: with regions, where it knows nothing else.
PointCloud grid_for(const RendererEntry& entry, int n) {
  PointCloud cloud = scenes::flat_grid(n);
  if (entry.held_by == HeldBy::regions) cloud.fixture_radius_m.assign(cloud.size(), 0.005);
  return cloud;
}

// A press into a flat cloud with a new frame every 33 ticks, and back out.
std::vector<RenderOutput> press(const RendererEntry& entry, Renderer& renderer) {
  std::vector<RenderOutput> outputs;
  for (int tick = 0; tick < 200; ++tick) {
    if (tick % 33 == 0) renderer.on_frame(scenes::frame(grid_for(entry, 60), tick / 33));
    const double depth = tick < 100 ? 0.02 - 0.0005 * tick : -0.03 + 0.0005 * (tick - 100);
    outputs.push_back(renderer.step({Vec3(0.0001 * tick, depth, 0)}, 0.001 * tick));
  }
  return outputs;
}

TEST(RendererContract, NoForceInFreeSpace) {
  for (const RendererEntry& entry : renderers()) {
    const auto renderer = build(entry);
    renderer->on_frame(scenes::frame(grid_for(entry, 40)));
    for (int tick = 0; tick < 50; ++tick) {
      const RenderOutput out = renderer->step({Vec3(0.001 * tick, 0.03, 0)}, 0.001 * tick);
      EXPECT_TRUE(out.force_N.isZero(0)) << entry.name;
      EXPECT_EQ(out.state, ContactState::free) << entry.name;
      EXPECT_EQ(out.status, RenderStatus::ok) << entry.name;
    }
  }
}

TEST(RendererContract, HasAsManyDegreesOfFreedomAsItsEntrySays) {
  for (const RendererEntry& entry : renderers()) {
    const auto renderer = build(entry);
    EXPECT_EQ(renderer->step({}, 0).tool.has_value(), entry.freedoms == Freedoms::six) << entry.name;
    renderer->on_frame(scenes::frame(grid_for(entry, 40)));
    EXPECT_EQ(renderer->step({}, 0.001).tool.has_value(), entry.freedoms == Freedoms::six) << entry.name;
  }
}

TEST(RendererContract, PushesTheHandOutOfTheSurface) {
  for (const RendererEntry& entry : renderers()) {
    const auto renderer = build(entry);
    double highest = 0;
    for (const RenderOutput& out : press(entry, *renderer)) highest = std::max(highest, out.force_N.y());
    EXPECT_GT(highest, 1) << entry.name;
  }
}

TEST(RendererContract, SameInputSameBits) {
  for (const RendererEntry& entry : renderers()) {
    const auto first = build(entry), second = build(entry);
    const auto a = press(entry, *first), b = press(entry, *second);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].proxy_W, b[i].proxy_W) << entry.name;
      EXPECT_EQ(a[i].force_N, b[i].force_N) << entry.name;
      EXPECT_EQ(a[i].steps, b[i].steps) << entry.name;
    }
  }
}

TEST(RendererContract, AStepAllocatesNothing) {
  for (const RendererEntry& entry : renderers()) {
    const auto renderer = build(entry);
    renderer->on_frame(scenes::frame(grid_for(entry, 100)));
    for (int tick = 0; tick < 300; ++tick) {
      // Approach, press, slide fast, jump across the cloud.
      const Vec3 hip(tick < 200 ? 0 : 0.002 * (tick - 250), tick < 100 ? 0.02 - 0.0004 * tick : -0.02,
                     tick % 50 == 0 ? 0.05 : 0);
      const std::size_t before = allocation_count();
      renderer->step({hip}, 0.001 * tick);
      EXPECT_EQ(allocation_count(), before) << entry.name << " at tick " << tick;
    }
  }
}

// With guidance and a task on top of it as well.
TEST(RendererContract, AGuidedStepAllocatesNothing) {
  std::vector<FixtureValues> fixtures(2);
  fixtures[0].label = "table";
  fixtures[1].label = "valve", fixtures[1].role = FixtureRole::guidance;
  SequenceStep lock, activate;
  lock.action = FixtureAction::lock, lock.fixture = "table", lock.not_before_s = 0.05;
  activate.action = FixtureAction::activate, activate.fixture = "valve", activate.start = StepStart::button;
  activate.done = StepEnd::reached, activate.deadline_s = 0.1;
  for (const RendererEntry& entry : renderers()) {
    GuidedRenderer renderer(build(entry), {}, fixtures, {lock, activate},
                            std::make_shared<FixtureSwitches>());
    Frame frame = scenes::frame(grid_for(entry, 100));
    frame.guidance = {{100, Vec3(0.2, 0, 0), Vec3::UnitY()}};
    renderer.on_frame(frame);
    RenderOutput out;
    for (int tick = 0; tick < 300; ++tick) {
      const DeviceState device{Vec3(0, 0.02 - 0.0004 * std::min(tick, 100), 0),
                               Eigen::Quaterniond::Identity(), tick / 10 % 10 == 9 ? 1u : 0u};
      const std::size_t before = allocation_count();
      out = renderer.step(device, 0.001 * tick);
      EXPECT_EQ(allocation_count(), before) << entry.name << " at tick " << tick;
    }
    EXPECT_EQ(out.guidance->sequence_missed, 1) << entry.name;
    EXPECT_TRUE(out.guidance->pulls) << entry.name;
  }
}

TEST(RendererContract, WithoutAFrameTheProxyIsTheHip) {
  for (const RendererEntry& entry : renderers()) {
    const auto renderer = build(entry);
    const RenderOutput out = renderer->step({Vec3(1, 2, 3)}, 0);
    EXPECT_EQ(out.proxy_W, Vec3(1, 2, 3)) << entry.name;
    EXPECT_EQ(out.status, RenderStatus::no_frame) << entry.name;
    EXPECT_EQ(out.frame_index, -1) << entry.name;
  }
}

TEST(RendererContract, ADeviceThatIsNotFiniteGetsNoForceAndDoesNoHarm) {
  for (const RendererEntry& entry : renderers()) {
    const auto renderer = build(entry);
    renderer->on_frame(scenes::frame(grid_for(entry, 60)));
    renderer->step({Vec3(0, 0.02, 0)}, 0);
    const RenderOutput before = renderer->step({Vec3(0, -0.02, 0)}, 0.001);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      const RenderOutput out = renderer->step({Vec3(0, bad, 0)}, 0.002);
      EXPECT_EQ(out.status, RenderStatus::device_not_finite) << entry.name;
      EXPECT_TRUE(out.force_N.isZero(0)) << entry.name;
      EXPECT_TRUE(out.proxy_W.allFinite()) << entry.name;
    }
    const RenderOutput after = renderer->step({Vec3(0, -0.02, 0)}, 0.003);
    EXPECT_NEAR((after.proxy_W - before.proxy_W).norm(), 0, 1e-3) << entry.name;
    EXPECT_GT(after.force_N.y(), 1) << entry.name;
  }
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

  // With the defaults of the catalog; the recording gets one that is made here.
  std::unique_ptr<Scenario> build(const ScenarioEntry& entry) const {
    auto blueprint = entry.make();
    for (const Parameter& p : blueprint->settings())
      if (p.name == "path") *std::get<std::string*>(p.value) = folder_.path().string();
    return blueprint->build(NoiseKey{7}, scenes::kernels());
  }

  TestFolder folder_{"contract"};
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// A result is to hold the hashes of all files that it was made from.
TEST_F(ScenarioContract, FilesThatSettingsNameAreTold) {
  for (const ScenarioEntry& entry : scenarios()) {
    const auto blueprint = entry.make();
    for (const Parameter& p : blueprint->settings()) {
      if (p.name != "path") continue;
      *std::get<std::string*>(p.value) = folder_.path().string();
      ASSERT_EQ(blueprint->inputs().size(), 1u) << entry.name;
      EXPECT_EQ(blueprint->inputs()[0].path, folder_.path()) << entry.name;
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
  auto blueprint(const FixtureEntry& entry) const {
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
    const std::vector<double> shares = blueprint(entry)->build()->shares(cloud);
    ASSERT_EQ(shares.size(), cloud.size()) << entry.name;
    double sum = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      EXPECT_TRUE(shares[i] >= 0 && shares[i] <= 1) << entry.name << " " << i;
      if (!cloud.point(i).allFinite()) {
        EXPECT_EQ(shares[i], 0) << entry.name << " " << i;
      }
      sum += shares[i];
    }
    // The wall is too far away from the point that near-point has by default.
    EXPECT_EQ(sum > 0, entry.name != std::string("near-point")) << entry.name;
  }
}

TEST_F(FixtureContract, NothingIsPickedOfAFrameThatSawNothing) {
  for (const FixtureEntry& entry : fixtures()) {
    PointCloud cloud = coloured_image();
    cloud.x.assign(cloud.size(), std::numeric_limits<double>::quiet_NaN()), cloud.y = cloud.z = cloud.x;
    EXPECT_EQ(blueprint(entry)->build()->shares(cloud), std::vector<double>(cloud.size())) << entry.name;
  }
}

TEST_F(FixtureContract, SharesArePure) {
  for (const FixtureEntry& entry : fixtures()) {
    const PointCloud cloud = coloured_image();
    PointCloud other = cloud;
    other.x[20] += 1, other.colour[30] = 0;
    const auto one = blueprint(entry)->build(), fresh = blueprint(entry)->build();
    const std::vector<double> first = one->shares(cloud);
    one->shares(other);  // what it was asked before changes nothing
    EXPECT_TRUE(same_bits(one->shares(cloud), first)) << entry.name;
    EXPECT_TRUE(same_bits(fresh->shares(cloud), first)) << entry.name;
  }
}

TEST_F(FixtureContract, GivesTheValuesOfItsSettings) {
  for (const FixtureEntry& entry : fixtures()) {
    const auto made = blueprint(entry);
    const Json set = {{"radius_m", 0.25}, {"stiffness_N_per_m", 77}, {"schedule", {{1, 0.5}, {2, 0}}}};
    read_parameters(set, made->settings(), entry.name, false);
    EXPECT_EQ(made->contradiction(), "") << entry.name;
    const auto rule = made->build();
    EXPECT_EQ(rule->values().radius_m, 0.25) << entry.name;
    EXPECT_EQ(rule->values().stiffness_N_per_m, 77) << entry.name;
    EXPECT_EQ(rule->strength(0), 0.5) << entry.name;
    EXPECT_TRUE(rule->changes_with_time()) << entry.name;
    read_parameters({{"schedule", {{1, 0.5}, {0, 0}}}}, made->settings(), entry.name, false);
    EXPECT_HAS(made->contradiction(), "schedule: time") << entry.name;
  }
}

TEST_F(FixtureContract, FilesThatSettingsNameAreTold) {
  for (const FixtureEntry& entry : fixtures()) {
    const auto made = blueprint(entry);
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
    const auto made = blueprint(entry);
    read_parameters({{"radius_m", 0.1 + 0.2}, {"schedule", {{0, 0.1}, {1e-3, 1}}}}, made->settings(),
                    entry.name, false);
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
    const auto one = entry.make()->build(*scene), other = entry.make()->build(*scene);
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
  ASSERT_FALSE(stored_experiments().empty());
  for (const StoredText& stored : stored_experiments()) {
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
}  // namespace remote_touch
