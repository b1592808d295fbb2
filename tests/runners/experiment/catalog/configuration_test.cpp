// Settings of a renderer that change during a run, where every renderer holds its contact, and the catalog.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/trace.h"
#include "core/points/point_cloud.h"
#include "core/rivals/implicit_surface_renderers.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/evaluation/verification/metamorphic_checks.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/files/input_files.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::configuration_test {
namespace {

// A renderer that states any stiffness as its largest: NaN for the setting 0, infinity for a large one, and
// the setting less 1 otherwise.
class Boaster final : public Renderer {
 public:
  struct Settings {
    double stiffness = 1;
  };
  Boaster(const Settings&, double, const Kernels&) {}
  void on_frame(const Frame&) override {}
  RenderOutput step(const DeviceState&, double) override { return {}; }
};
Parameters parameters(Boaster::Settings& s) {
  return {{"stiffness", &s.stiffness, -1e9, 1e9, "a number", kLive}};
}
std::string validate(const Boaster::Settings&) {
  return {};
}
double max_stiffness_N_per_m(const Boaster::Settings& s) {
  return s.stiffness == 0 ? std::nan("") : s.stiffness > 1e8 ? HUGE_VAL : s.stiffness - 1;
}
RenderedContact rendered_contact(const Boaster::Settings&) {
  return RenderedContact::unknown();
}

std::string change(const char* time_s, const std::string& parameter, const char* value) {
  return std::string(R"({"time_s": )") + time_s + R"(, "parameter": ")" + parameter + R"(", "value": )" +
         value + "}";
}

// The proxy is in contact from 0.5 s on, and rises.
Experiment lift(const std::string& changes = "[]", std::vector<std::string> more = {}) {
  for (const char* setting :
       {"scenario.columns=80", "scenario.rows=80", "scenario.noise_sigma_m=0.001", "duration_s=0.8"})
    more.emplace_back(setting);
  more.push_back("changes=" + changes);
  return Experiment::load("fig4.12", more);
}

// --- changes of settings ---

// A device scales forces by the greatest stiffness that will come.
TEST(RendererChanges, TheGreatestStiffnessIsThatOfAnyTime) {
  EXPECT_EQ(lift().max_stiffness_N_per_m(), 600);
  const std::string stiffer = change("0.1", "renderer.stiffness_N_per_m", "900"),
                    softer = change("0.2", "renderer.stiffness_N_per_m", "100");
  EXPECT_EQ(lift("[" + stiffer + ", " + softer + "]").max_stiffness_N_per_m(), 900);
  EXPECT_EQ(lift("[" + softer + "]").max_stiffness_N_per_m(), 600);
}

// The force of a device is scaled by it, so a stiffness that is none must not pass as a small one.
TEST(RendererChanges, AStiffnessThatIsNoneIsRefusedForEveryFactory) {
  Catalog catalog = built_in_catalog();
  catalog.add(renderer_entry<Boaster>("boaster", DegreesOfFreedom::three, "boasts"));
  use_catalog(std::move(catalog));
  const auto refused = [](const std::string& at_start, const std::string& later) {
    return refusal([&] {
      lift("[" + change("0.1", "renderer.stiffness", later.c_str()) + "]",
           {R"(renderer={"name": "boaster", "stiffness": )" + at_start + "}"});
    });
  };
  EXPECT_EQ(refused("1", "601"), "no InputError");
  for (const char* none : {"0", "0.5", "1e9"}) {
    const std::string line = "max_stiffness_N_per_m of the renderer boaster = ";
    EXPECT_HAS(refused(none, "601"), line);
    EXPECT_HAS(refused("601", none), line);
  }
  use_catalog(built_in_catalog());
}

TEST(RendererChanges, TakeEffectInTheFirstTickAtOrAfterTheirTime) {
  const Trace plain = simulate(lift());
  const auto first_other = [&](const char* time_s) {
    const Trace changed =
        simulate(lift(std::string("[") + change(time_s, "renderer.stiffness_N_per_m", "1200") + "]"));
    std::size_t tick = 0;
    while (tick < plain.length() && changed.force_N[tick] == plain.force_N[tick]) ++tick;
    return tick;
  };
  std::size_t touched = 0;  // first tick with a force
  while (plain.force_N[touched].isZero(0)) ++touched;
  ASSERT_LT(touched, 650u);
  EXPECT_EQ(first_other("0.65"), 650u);
  EXPECT_EQ(first_other("0.6501"), 651u);
}

// Once the estimate is off, v_hat is no part of the force (4.15).
TEST(RendererChanges, SurfaceIsAtRestOnceTheEstimateIsOff) {
  const Trace changed = simulate(lift("[" + change("0.65", "renderer.velocity_estimate", "0") + "]"));
  EXPECT_GT(changed.surface_velocity_m_per_s[649], 0);
  for (std::size_t tick = 650; tick < 800; ++tick)
    EXPECT_EQ(changed.surface_velocity_m_per_s[tick], 0) << tick;
}

TEST(RendererChanges, MakingThemAllocatesNothing) {
  const Experiment experiment = lift("[" + change("0.1", "renderer.r3_m", "0.02") + "]");
  const auto renderer = experiment.build_renderer(scenes::kernels());
  renderer->on_frame(scenes::frame(scenes::flat_grid(60)));
  RendererChanges changes(experiment.changes(), *renderer);
  changes.make_until(0.0999);
  EXPECT_EQ(number_of(renderer->live_parameters()[2]), 0.01);
  const std::size_t before = allocation_count();
  changes.make_until(0.1);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_EQ(number_of(renderer->live_parameters()[2]), 0.02);
}

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
  std::string name, renderer;
  double spacing_m = kDense_m, depth_m = 0.01;
};
const Pressed kOthers[] = {
    {"proxy_with_other_radii", R"({"name": "proxy", "r1_m": 0.00199, "r2_m": 0.00201, "r3_m": 0.004})"},
    {"god_object_above_the_points", R"({"name": "god-object", "surface_offset_m": 0.001})"},
    {"averaged_proxy_by_mean", R"({"name": "averaged-proxy", "average": "mean"})"},
    {"penalty_with_another_radius",
     R"({"name": "penalty", "contact_radius_m": 0.003, "stiffness_N_per_m": 100})", kDense_m, -0.001},
    {"surface_of_surfels", R"({"name": "implicit-surface", "surface": "surfels"})"},
    {"surface_by_wendland", R"({"name": "implicit-surface", "weight": "wendland", "threshold": 1})",
     kReferenceSpacing_m},
    {"surface_with_a_wide_support", R"({"name": "implicit-surface", "support_radius_m": 0.015})",
     kReferenceSpacing_m},
};

// Every renderer with a known rest distance with its defaults, and the others. A HIP below the points pops
// through if nothing holds it. Surfaces with weights are slow on the dense grid, and not known any better
// there.
std::vector<Pressed> all_pressed() {
  std::vector<Pressed> all(std::begin(kOthers), std::end(kOthers));
  for (const RendererEntry& entry : renderers()) {
    if (std::isnan(entry.make()->contact().rest_distance_m)) continue;
    const bool is_weighted = entry.name == "implicit-surface" || entry.name == "mls-surface";
    std::string name = entry.name;
    std::ranges::replace(name, '-', '_');
    all.push_back({name, R"({"name": ")" + entry.name + "\"}", is_weighted ? kReferenceSpacing_m : kDense_m,
                   contact_model_of(entry.name).pressed_hip_passes_through ? -0.002 : 0.01});
  }
  return all;
}

class Held : public testing::TestWithParam<Pressed> {};

TEST_P(Held, TheContactPointIsOnTheSurface) {
  const auto& [name, renderer, spacing_m, depth_m] = GetParam();
  const Trace trace = pressed(renderer, spacing_m, depth_m);
  ASSERT_TRUE(trace.has_contact());
  EXPECT_FALSE(trace.force_N.back().isZero(0));
  EXPECT_NEAR(trace.contact.back().hip_distance_m, -depth_m, 1e-12);
  EXPECT_NEAR(trace.contact.back().height_m, 0, 5e-6);
}

INSTANTIATE_TEST_SUITE_P(Renderers, Held, testing::ValuesIn(all_pressed()),
                         [](const auto& pressed) { return pressed.param.name; });

TEST(RendererContacts, AreKnownOfEveryRendererOfThreeDegreesOfFreedom) {
  for (const RendererEntry& entry : renderers())
    EXPECT_EQ(!std::isnan(entry.make()->contact().rest_distance_m),
              entry.degrees_of_freedom == DegreesOfFreedom::three)
        << entry.name;
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

}  // namespace
}  // namespace remote_touch::configuration_test
