#include "runners/sweep/sweep.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/sweep/stored_sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_axis_test {
namespace {

// Axes that set several parameters together: coupled parameters and variants.

constexpr const char* kRadii = R"({"name": "r_c", "parameters": ["renderer.r1_m", "renderer.r2_m"],
  "values": [[0.004, 0.0042], [0.005, 0.0052]]})";
constexpr const char* kSpeeds = R"({"name": "variant", "variants": [{"name": "as printed"},
  {"name": "slow", "set": {"renderer.steps_per_tick": 1}}, {"name": "other", "set": {"renderer.xi": 0.25}}]})";
constexpr const char* kVariants = R"({"name": "variant", "variants": [{"name": "as printed"},
  {"name": "slow", "set": {"renderer.steps_per_tick": 1, "renderer.xi": 0.25}},
  {"name": "other", "set": {"renderer": {"name": "proxy", "stiffness_N_per_m": 400}}}]})";

Sweep along(const std::string& axes) {
  return Sweep::from_json(
      R"({"experiment": "fig4.12", "replicates": 2, "measures": ["mean_steps"], "axes": [)" + axes + "]}",
      "mine.json");
}
std::string why(const std::string& axes) {
  return refusal([&] { along(axes); });
}
Json value_in(const Sweep& sweep, std::size_t cell, const std::string& pointer) {
  return Json::parse(sweep.experiment(cell, 1).to_json())[Json::json_pointer(pointer)];
}

TEST(JointAxes, SetAllTheirParametersTogether) {
  const Sweep sweep = along(kRadii);
  EXPECT_EQ(value_in(sweep, 0, "/renderer/r1_m"), 0.004);
  EXPECT_EQ(value_in(sweep, 0, "/renderer/r2_m"), 0.0042);
  EXPECT_EQ(value_in(sweep, 1, "/renderer/r1_m"), 0.005);
  EXPECT_EQ(value_in(sweep, 1, "/renderer/r2_m"), 0.0052);
}

TEST(JointAxes, HaveACoordinateWithNameAndUnit) {
  const Column plain = along(kRadii).plan().axes.at(0);
  EXPECT_EQ(plain.name, "r_c");
  EXPECT_EQ(plain.units, "m");
  EXPECT_EQ(plain.long_name, "renderer.r1_m, renderer.r2_m");
  EXPECT_EQ(std::get<std::vector<double>>(plain.values), (std::vector<double>{0.004, 0.005}));

  const std::string labelled =
      R"({"name": "r_c", "unit": "mm", "labels": [5, 10], )" + std::string(kRadii + 16);
  const Column labels = along(labelled).plan().axes.at(0);
  EXPECT_EQ(labels.units, "mm");
  EXPECT_EQ(std::get<std::vector<double>>(labels.values), (std::vector<double>{5, 10}));

  const std::string named = R"({"name": "r_c", "labels": ["narrow", "wide"], )" + std::string(kRadii + 16);
  EXPECT_EQ(along(named).plan().axes.at(0).value_names, (std::vector<std::string>{"narrow", "wide"}));
}

TEST(JointAxes, CellsAreNamedByTheCoordinate) {
  const SweepResult plan = along(std::string(kRadii) + ", " + kSpeeds).plan();
  EXPECT_EQ(cell_of({"--cell", "r_c=0.005,variant=slow"}, plan), 4u);
  EXPECT_EQ(cell_of({"--cell", "variant=as printed,r_c=0.004"}, plan), 0u);
  EXPECT_HAS(refusal([&] {
               cell_of({"--cell", "r_c=0.02,variant=slow"}, plan);
             }),
             "expected for r_c one of 0.004, 0.005");
}

TEST(JointAxes, TitlesStateTheCoordinate) {
  const Sweep sweep = along(std::string(kRadii) + ", " + kSpeeds);
  EXPECT_TRUE(sweep.title().ends_with(", over r_c and variant")) << sweep.title();
  const std::string title = value_in(sweep, 4, "/title");
  EXPECT_TRUE(title.ends_with("changed: r_c=0.005, variant=slow")) << title;
}

TEST(JointAxes, SurviveARoundTrip) {
  const Sweep sweep = along(std::string(kRadii) + ", " + kSpeeds);
  const Sweep again = Sweep::from_json(sweep.to_json(), "again");
  EXPECT_EQ(again.to_json(), sweep.to_json());
  EXPECT_NO_THROW(again.require_fits(sweep.plan(), "file"));
  EXPECT_EQ(again.experiment(4, 0).to_json(), sweep.experiment(4, 0).to_json());
}

TEST(JointAxes, CanBeThinned) {
  const SweepResult plan = along(std::string(kRadii) + ", " + kSpeeds).thinned(2).plan();
  EXPECT_EQ(plan.axes[0].length(), 1u);
  EXPECT_EQ(plan.axes[1].value_names, (std::vector<std::string>{"as printed", "other"}));
}

TEST(Variants, SetOnlyWhatTheyName) {
  const Sweep sweep = along(kVariants);
  const Json printed = value_in(sweep, 0, "/renderer");
  EXPECT_EQ(printed, value_in(along(R"({"parameter": "seed", "values": [1]})"), 0, "/renderer"));
  Json slow = printed;
  slow["steps_per_tick"] = 1, slow["xi"] = 0.25;
  EXPECT_EQ(value_in(sweep, 1, "/renderer"), slow);
  EXPECT_EQ(value_in(sweep, 2, "/renderer/stiffness_N_per_m"), 400);
}

// Then a difference between two variants is not one between two noises.
TEST(Variants, HaveCommonNoiseUnlessToldOtherwise) {
  const std::string noise = R"({"parameter": "scenario.noise_sigma_m", "values": [0.001, 0.002]})";
  const auto cell = [](const Sweep& sweep, std::size_t i) { return value_in(sweep, i, "/cell"); };
  const Sweep common = along(noise + ", " + kVariants);
  EXPECT_EQ(cell(common, 4), cell(common, 3));
  EXPECT_NE(cell(common, 3), cell(common, 0));
  EXPECT_EQ(value_in(common, 4, "/replicate"), 1);
  const Sweep own = along(noise + R"(, {"common_noise": false, )" + std::string(kVariants + 1));
  EXPECT_EQ(cell(own, 4), 4);
  EXPECT_EQ(Sweep::from_json(own.to_json(), "again").to_json(), own.to_json());
  const Sweep values =
      along(R"({"parameter": "scenario.noise_sigma_m", "values": [0.001, 0.002], "common_noise": true})");
  EXPECT_EQ(cell(values, 1), 0);
}

TEST(JointAxes, RefuseWhatTheyCannotState) {
  const auto axis = [](const std::string& rest) { return why(R"({"name": "r_c", )" + rest + "}"); };
  const std::string radii = R"("parameters": ["renderer.r1_m", "renderer.r2_m"], )";
  EXPECT_HAS(why(R"({"name": "r=c", )" + radii + R"("values": [[1, 2]]})"),
             "axes.0.name = \"r=c\": expected a letter, then letters, digits and _");
  EXPECT_HAS(axis(radii + R"("values": [[0.005]])"),
             "axes.0.values.0: [0.005]: expected a list of 2 values, one for each parameter");
  EXPECT_HAS(axis(radii + R"("values": [[0.005, 0.006], [0.005, 0.007]])"), "0.005 appears twice");
  EXPECT_HAS(axis(radii + R"("values": [[0.005, 0.006]], "unit": "mm")"),
             "axes.0.unit = \"mm\": expected m, the unit of renderer.r1_m, or labels");
  EXPECT_HAS(axis(radii + R"("values": [[0.005, 0.006]], "labels": [1, 2])"),
             "axes.0.labels: expected 1 numbers or as many names");
  EXPECT_HAS(axis(radii + R"("values": [[0.005, 0.006]], "label": [1])"), "axes.0.label");
  EXPECT_HAS(axis(R"("parameters": ["renderer", "renderer.r1_m"], "values": [[{"name": "proxy"}, 0.01]])"),
             "axes.0.parameters: renderer.r1_m overlaps renderer");
  EXPECT_HAS(axis(R"("parameters": ["trajectory.poses.0.."], "values": [[1]])"),
             "axes.0.parameters: \"trajectory.poses.0..\": expected the path of a parameter");
  EXPECT_HAS(axis(R"("parameters": ["renderer.r9_m"], "values": [[1]])"), "r9_m");
  EXPECT_HAS(axis(R"("parameters": ["safety.max_force_N"], "values": [[1]])"), "only live runs use section");
}

TEST(Variants, RefuseWhatTheyCannotState) {
  const auto axis = [](const std::string& variants) {
    return why(R"({"name": "variant", "variants": )" + variants + "}");
  };
  EXPECT_HAS(axis("[]"), "axes.0.variants: expected a list of");
  EXPECT_HAS(axis(R"([{"name": "a"}, {"name": "b"}])"), "axes.0.variants: none sets a parameter");
  EXPECT_HAS(axis(R"([{"name": "a", "set": {"": 1}}])"),
             "axes.0.variants.0.set: \"\": expected the path of a parameter");
  EXPECT_HAS(axis(R"([{"set": {"seed": 1}}])"), "axes.0.variants.0.name: expected a name");
  EXPECT_HAS(axis(R"([{"name": "a", "set": {"seed": 1}}, {"name": "a", "set": {"seed": 2}}])"),
             "\"a\" appears twice");
  EXPECT_HAS(axis(R"([{"name": "a", "set": {"renderer.name": "tracked-sheet"}}])"),
             "axis renderer.name = \"tracked-sheet\": expected renderer, with values like");
  EXPECT_HAS(axis(R"([{"name": "a", "set": {"renderer": {"name": "proxy"}, "renderer.xi": 0.5}}])"),
             "axes.0.variants.0.set: renderer.xi overlaps renderer");
}

TEST(JointAxes, MayNotOverlapOtherStatements) {
  EXPECT_HAS(why(std::string(kRadii) + R"(, {"parameter": "renderer.r2_m", "values": [0.01]})"),
             "axes.1 renderer.r2_m: overlaps axes.0 renderer.r2_m");
  EXPECT_HAS(refusal([] {
               Sweep::from_json(R"({"experiment": "fig4.12", "measures": ["mean_steps"],
                                    "set": {"renderer.r2_m": 0.02}, "axes": [)" +
                                    std::string(kRadii) + "]}",
                                "mine.json");
             }),
             "set.renderer.r2_m: is overwritten by the axis r_c (renderer.r2_m)");
}

std::string unit_over(const std::string& parameter) {
  return read_axis({{"parameter", parameter}, {"values", {1, 2}}}, "test", 0).coordinate.units;
}

TEST(SweepAxis, StatesTheUnitOfEveryKindOfParameter) {
  EXPECT_EQ(unit_over("scenario.noise_sigma_m"), "m");
  EXPECT_EQ(unit_over("scenario.turbidity_per_m"), "1/m");
  EXPECT_EQ(unit_over("safety.max_force_N"), "N");
  EXPECT_EQ(unit_over("scenario.rate_per_min"), "1/min");
  EXPECT_EQ(unit_over("device.mass_kg"), "kg");
  EXPECT_EQ(unit_over("renderer.steps_per_tick"), "1");
}

TEST(SweepAxis, StatesTheUnitOfOneElementOfAList) {
  EXPECT_EQ(unit_over("trajectory.poses.2.4"), "deg");
  EXPECT_EQ(unit_over("trajectory.poses.2.6"), "s");
  EXPECT_EQ(unit_over("trajectory.waypoints.0.3"), "m/s");
  EXPECT_EQ(unit_over("trajectory.waypoints.0.99"), "1");
  EXPECT_EQ(unit_over("scenario.centre_m.1"), "m");
}

}  // namespace
}  // namespace remote_touch::sweep_axis_test
