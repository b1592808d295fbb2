#include "runners/experiment/catalog/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/trace.h"
#include "core/points/point_cloud.h"
#include "core/rivals/implicit_surface_renderers.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/files/input_files.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::catalog_test {
namespace {

// The rest distance of every 3-DOF renderer: pressed on a flat cloud without noise, its contact point is on
// it.

// The HIP comes down on a flat cloud at rest and stays depth_m below it for 0.2 s.
Trace pressed(const std::string& renderer, double spacing_m, double depth_m) {
  const int nodes = static_cast<int>(0.03 / spacing_m);
  const Json experiment = {
      {"scenario", {{"name", "flat-grid"}, {"columns", nodes}, {"rows", nodes}, {"spacing_m", spacing_m}}},
      {"renderer", parse_json(renderer, "renderer")},
      {"trajectory",
       {{"name", "waypoints"}, {"waypoints", {{0.0, 0.02, 0.0, 0.0}, {0.0, -depth_m, 0.0, 0.2}}}}},
      {"duration_s", 0.4}};
  SimulationOptions options;
  options.find_true_contact = true;
  return simulate(Experiment::from_json(experiment), options);
}

// The grid is so dense that a ball sinks between points by only 0.1^2 / 4 / r_c = 0.5 um.
constexpr double kDense_m = 0.0001;

struct Pressed {
  const char* name;
  const char* renderer;
  double spacing_m, depth_m;
};
const Pressed kHeld[] = {
    {"proxy", R"({"name": "proxy"})", kDense_m, 0.01},
    {"proxy_with_other_radii", R"({"name": "proxy", "r1_m": 0.00199, "r2_m": 0.00201, "r3_m": 0.004})",
     kDense_m, 0.01},
    {"tracked_sheet", R"({"name": "tracked-sheet"})", kDense_m, 0.01},
    {"god_object", R"({"name": "god-object"})", kDense_m, 0.01},
    {"god_object_above_the_points", R"({"name": "god-object", "surface_offset_m": 0.001})", kDense_m, 0.01},
    {"surfels", R"({"name": "surfels"})", kDense_m, 0.01},
    {"mls_surface", R"({"name": "mls-surface"})", kReferenceSpacing_m, 0.01},
    {"averaged_proxy", R"({"name": "averaged-proxy"})", kDense_m, 0.01},
    {"averaged_proxy_by_mean", R"({"name": "averaged-proxy", "average": "mean"})", kDense_m, 0.01},
    {"density_proxy", R"({"name": "density-proxy"})", kDense_m, 0.01},
    {"oracle_proxy", R"({"name": "oracle-proxy"})", kDense_m, 0.01},
    {"penalty", R"({"name": "penalty"})", kDense_m, -0.002},  // a HIP below the points pops through
    {"penalty_with_another_radius",
     R"({"name": "penalty", "contact_radius_m": 0.003, "stiffness_N_per_m": 100})", kDense_m, -0.001},
    {"surface_of_surfels", R"({"name": "implicit-surface", "surface": "surfels"})", kDense_m, 0.01},
    {"implicit_surface", R"({"name": "implicit-surface"})", kReferenceSpacing_m, 0.01},
    {"surface_by_wendland", R"({"name": "implicit-surface", "weight": "wendland", "threshold": 1})",
     kReferenceSpacing_m, 0.01},
    {"surface_with_a_wide_support", R"({"name": "implicit-surface", "support_radius_m": 0.015})",
     kReferenceSpacing_m, 0.01},
};

class Held : public testing::TestWithParam<Pressed> {};

TEST_P(Held, TheContactPointIsOnTheSurface) {
  const auto& [name, renderer, spacing_m, depth_m] = GetParam();
  const Trace trace = pressed(renderer, spacing_m, depth_m);
  ASSERT_TRUE(trace.has_contact());
  EXPECT_FALSE(trace.force_N.back().isZero(0));
  EXPECT_NEAR(trace.contact.back().hip_distance_m, -depth_m, 1e-12);
  EXPECT_NEAR(trace.contact.back().height_m, 0, 5e-6);
}

INSTANTIATE_TEST_SUITE_P(Renderers, Held, testing::ValuesIn(kHeld),
                         [](const auto& pressed) { return pressed.param.name; });

TEST(RendererContacts, EveryRendererOfThreeDegreesOfFreedomIsPressed) {
  for (const RendererEntry& entry : renderers()) {
    const bool is_known = !std::isnan(entry.make()->contact().rest_distance_m);
    EXPECT_EQ(is_known, entry.degrees_of_freedom == DegreesOfFreedom::three) << entry.name;
    if (!is_known) continue;
    const std::string name = std::string("\"") + entry.name + "\"";
    bool found = false;
    for (const Pressed& one : kHeld) found |= std::string(one.renderer).find(name) != std::string::npos;
    EXPECT_TRUE(found) << entry.name << " has no press in this test";
  }
}

// A ball is held until its centre is behind the surface, a position on the surface until it has sunk 2.5 mm.
TEST(RendererContacts, HeldDepthDependsOnTheDistanceOfThePosition) {
  EXPECT_EQ(held_depth_m({0.005}), 0);
  EXPECT_EQ(held_depth_m({0.0025}), 0);
  EXPECT_DOUBLE_EQ(held_depth_m({0.001}), 0.0015);
  EXPECT_EQ(held_depth_m({0}), 0.0025);
  EXPECT_EQ(held_depth_m({std::nan("")}), 0) << "a tool";
}

// The depth of a hand in a spring is no error of the surface. A spring that lets the hand through is an
// error.
TEST(RendererContacts, APenaltyForceIsJudgedWhereItWouldEnd) {
  for (const double depth_m : {-0.004, -0.001})
    EXPECT_NEAR(pressed(R"({"name": "penalty"})", kDense_m, depth_m).contact.back().height_m, 0, 5e-6);
  EXPECT_NEAR(pressed(R"({"name": "penalty"})", kDense_m, 0.01).contact.back().height_m, -0.015, 5e-6);
  EXPECT_LT(max_sink_m(pressed(R"({"name": "proxy"})", kDense_m, 0.01)), 5e-6);
  EXPECT_NEAR(max_sink_m(pressed(R"({"name": "penalty"})", kDense_m, 0.01)), 0.015, 5e-6);
}

// The true contact is computed only if a measure needs it.
TEST(RendererContacts, AreComputedWhereAMeasureAsks) {
  const Experiment experiment = Experiment::from_json(
      R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"},
          "trajectory": {"name": "waypoints", "waypoints": [[0, 0.02, 0, 0]]}, "duration_s": 0.01})",
      "flat");
  EXPECT_FALSE(simulate(experiment).has_contact());
}

TEST(Catalog, NamesAreUniqueAndDescribed) {
  const auto check = [](const auto& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      EXPECT_GT(std::string(entries[i].summary).size(), 10u) << entries[i].name;
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_NE(std::string(entries[i].name), std::string(entries[j].name));
    }
  };
  check(scenarios()), check(fixtures()), check(renderers()), check(trajectories()), check(figures());
}

TEST(Catalog, OtherSeedsGiveOtherNoise) {
  for (const char* name : {"moving-lift", "camera-scene", "beating-heart", "valve-tank"}) {
    const auto entry = find_entry(scenarios(), name, "scenario");
    const PointCloud a = entry.make()->build(NoiseKey{1}, scenes::kernels())->cloud(0);
    const PointCloud b = entry.make()->build(NoiseKey{2}, scenes::kernels())->cloud(0);
    std::size_t other = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      other += std::abs(a.y[i] - b.y[i]) > 0 ? 1 : 0;  // false for a pixel that saw nothing
    EXPECT_GT(other, a.size() / 10) << name;
  }
}

// A wall of all colours, 0.6 m away: too far from the point that near-point has by default.
TEST(Catalog, FixtureRulesPickPointsWithTheirDefaults) {
  PointCloud cloud;
  cloud.image = ImageLayout{{8, 6, 10, 10, 3.5, 2.5}, RigidTransform::Identity(), 0};
  for (int i = 0; i < 48; ++i) {
    cloud.append(unproject(cloud.image->camera, i % 8, i / 8, 0.6));
    cloud.colour.push_back(static_cast<std::uint32_t>(i * 349525));
  }
  for (const char* name : {"everywhere", "half-space", "near-point", "hue-range"}) {
    double sum = 0;
    for (const double weight : find_entry(fixtures(), name, "fixture").make()->build()->weights(cloud))
      sum += weight;
    EXPECT_EQ(sum > 0, name != std::string("near-point")) << name;
  }
}

TEST(Catalog, HasTheDirectionOfEveryMeasure) {
  EXPECT_EQ(directions().size(), measures().size());
  EXPECT_EQ(directions().at("popped_through"), Better::smaller);
  EXPECT_EQ(directions().at("max_force"), Better::neither);
}

TEST(Catalog, AnEntryNeedsAFreeAndPlainName) {
  Catalog catalog = built_in_catalog();
  const auto add = [&](const char* name) {
    catalog.add(scenario_entry<FlatGrid>(name, "one point at rest, for a test"));
  };
  EXPECT_TRUE(own_entries(catalog).is_empty());
  add("mine");
  EXPECT_EQ(own_entries(catalog).scenarios().size(), 1u);
  EXPECT_EQ(refusal([&] { add("mine"); }), "scenario \"mine\": is in the catalog already");
  EXPECT_HAS(refusal([&] { add("flat-grid"); }), "is in the catalog already");
  EXPECT_HAS(refusal([&] {
               catalog.add(Measure{"empty", "N", "no function", MeasuredRuns::all, {}});
             }),
             "has no function");
  for (const char* name : {"", "My scene", "a/b", "a=b"})
    EXPECT_HAS(refusal([&] { add(name); }), "expected a name of lower case letters");
}

}  // namespace
}  // namespace remote_touch::catalog_test
