#include "runners/evaluation/contract/contract_tests.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {
namespace {

// One rule for one entry.
class ContractTest : public testing::Test {
 public:
  explicit ContractTest(std::function<void()> body) : body_(std::move(body)) {}
  void TestBody() override { body_(); }

 private:
  std::function<void()> body_;
};

void register_test(const char* suite, const std::string& name, const std::function<void()>& body) {
  testing::RegisterTest(suite, name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                        [body] { return new ContractTest(body); });
}

template <class Entry>
void register_checks(const char* suite, std::span<const Entry> entries,
                     std::span<const ContractCheck<Entry>> checks, const FillSettings& fill) {
  for (const Entry& entry : entries)
    for (const ContractCheck<Entry>& check : checks)
      register_test(suite, std::string(check.name) + "/" + entry.name,
                    [entry, fill, of = check.of] { of(entry, fill); });
}

template <class Entry>
void add_all(Catalog& catalog, std::span<const Entry> entries) {
  for (const Entry& entry : entries) catalog.add(entry);
}

Catalog with_built_in(const Catalog& catalog) {
  Catalog all = built_in_catalog();
  const Catalog own = own_entries(catalog);
  add_all(all, own.scenarios()), add_all(all, own.fixtures()), add_all(all, own.trajectories());
  add_all(all, own.renderers()), add_all(all, own.measures());
  return all;
}

// The contract of every fixture rule.

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

// The contract of every measure.

// Returns four traces: a press, a press of a tool, a run with guidance, and a copy of the first press whose
// distances to the surface are unknown (NaN). The runs are simulated once.
const std::vector<Trace>& traces() {
  static const std::vector<Trace> all = [] {
    std::vector<Trace> made;
    SimulationOptions options;
    options.find_true_contact = true;
    for (const char* experiment : {"fig4.11", "tool-slab", "fixture-tasks"})
      made.push_back(simulate(Experiment::load(experiment, {"duration_s=0.1"}), options));
    Trace unknown = made.front();
    for (double& distance_m : unknown.signed_distance_m) distance_m = std::nan("");
    unknown.slave_distance_m = unknown.signed_distance_m;
    made.push_back(std::move(unknown));
    return made;
  }();
  return all;
}

bool same_value(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void is_described(const Measure& measure, const FillSettings&) {
  EXPECT_GT(measure.meaning.size(), 10u);
  EXPECT_FALSE(measure.unit.empty()) << "expected \"1\" for a number without a unit";
  ASSERT_TRUE(measure.compute);
}

void the_same_trace_has_the_same_value(const Measure& measure, const FillSettings&) {
  for (const Trace& trace : traces()) {
    if (!applies(measure, trace)) continue;
    const double first = measure.compute(trace);
    EXPECT_TRUE(same_value(measure.compute(trace), first));
    EXPECT_FALSE(std::isinf(first)) << "expected NaN where nothing can be said";
  }
}

void a_trace_without_ticks_does_no_harm(const Measure& measure, const FillSettings&) {
  const Trace none;
  EXPECT_FALSE(std::isinf(measure.compute(none)));
}

constexpr ContractCheck<Measure> kMeasureChecks[] = {
    {"IsDescribed", is_described},
    {"TheSameTraceHasTheSameValue", the_same_trace_has_the_same_value},
    {"ATraceWithoutTicksDoesNoHarm", a_trace_without_ticks_does_no_harm},
};

// The contract of every scenario.

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

// The nearest point of the surface is at most as much farther from another position as the two are apart.
// Only beside the border of a surface, which has no back there, may the sign change without the surface
// between. The truth of a recording is measured, and may have gaps.
void the_true_distance_is_one(const ScenarioEntry& entry, const FillSettings& fill) {
  const auto scenario = scenario_of(entry, fill);
  if (!scenario->truth_text().empty()) return;
  const PointCloud cloud = scenario->cloud(0);
  if (cloud.size() == 0) return;  // FramesArePure finds it
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.02);
  const auto displacement = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z);
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec3 near = cloud.point(random() % cloud.size()) + displacement(),
               other = near + std::pow(0.1, i % 4) * displacement();
    if (!near.allFinite()) continue;
    for (const double time_s : {0.0, 0.7}) {
      const double change =
          scenario->signed_distance(other, time_s) - scenario->signed_distance(near, time_s);
      EXPECT_FALSE(std::abs(change) > 1.5 * (other - near).norm() + 1e-9)  // or NaN: one is not known
          << change << " m between " << near.transpose() << " and " << other.transpose();
    }
  }
}

constexpr ContractCheck<ScenarioEntry> kScenarioChecks[] = {
    {"ItsDefaultsAreValid", its_defaults_are_valid},
    {"FilesThatSettingsNameAreTold", files_that_settings_name_are_told},
    {"FramesArePure", frames_are_pure},
    {"SearchAndCloudShowTheSamePoints", search_and_cloud_show_the_same_points},
    {"RatesAndTimesMakeSense", rates_and_times_make_sense},
    {"NormalsAreOneAPointAndOfUnitLength", normals_are_one_a_point_and_of_unit_length},
    {"TheTrueDistanceIsOne", the_true_distance_is_one},
};

// The contract of every scripted hand.

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

void check_settings(Configurable& factory) {
  std::set<std::string> names = {"name"};  // of the entry itself, in every configuration
  for (const Parameter& p : factory.settings()) {
    EXPECT_TRUE(names.insert(p.name).second) << "a setting called " << p.name << ": expected another name";
    EXPECT_FALSE(p.help.empty()) << p.name << ": expected a line of help";
    Json value = Json::object();
    write_parameters({p}, value);
    try {
      read_parameters(value, {p}, "");
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_EQ(factory.validate(), "");
}

void register_contract_tests(const Catalog& catalog, const FillSettings& fill) {
  use_catalog(with_built_in(catalog));
  register_checks("ScenarioContract", catalog.scenarios(), scenario_checks(), fill);
  register_checks("FixtureContract", catalog.fixtures(), fixture_checks(), fill);
  register_checks("TrajectoryContract", catalog.trajectories(), trajectory_checks(), fill);
  register_checks("RendererContract", catalog.renderers(), renderer_checks(), fill);
  register_checks("MeasureContract", catalog.measures(), measure_checks(), fill);
}

std::span<const ContractCheck<FixtureEntry>> fixture_checks() {
  return kFixtureChecks;
}

std::span<const ContractCheck<Measure>> measure_checks() {
  return kMeasureChecks;
}

std::span<const ContractCheck<ScenarioEntry>> scenario_checks() {
  return kScenarioChecks;
}

std::span<const ContractCheck<TrajectoryEntry>> trajectory_checks() {
  return kTrajectoryChecks;
}

}  // namespace remote_touch
