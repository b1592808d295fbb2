// Settings of a renderer that change during a run.
#include "runners/experiment/catalog/configuration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/trace/trace.h"
#include "runners/evaluation/contract/allocation_counter.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
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
std::string why(const std::string& changes) {
  return refusal([&] { lift(changes); });
}

// --- what is refused ---

TEST(RendererChanges, AcceptOnlyLiveParametersInTheirRange) {
  EXPECT_EQ(
      why("[" + change("0.1", "renderer.gamma", "0.2") + "]"),
      "changes.0.parameter = renderer.gamma: expected one of renderer.r1_m, renderer.r2_m, renderer.r3_m, "
      "renderer.stiffness_N_per_m, renderer.velocity_estimate");
  EXPECT_HAS(why("[" + change("0.1", "stiffness_N_per_m", "2") + "]"), "expected one of renderer.r1_m");
  EXPECT_EQ(why("[" + change("0.1", "renderer.stiffness_N_per_m", "10001") + "]"),
            "changes.0.value = 10001.0: expected 0 to 10000, the range of renderer.stiffness_N_per_m");
  EXPECT_EQ(why("[" + change("0.1", "renderer.velocity_estimate", "0.5") + "]"),
            "changes.0.value = 0.5: expected 0 or 1, the range of renderer.velocity_estimate");
  EXPECT_HAS(why("[" + change("-1", "renderer.r3_m", "0.02") + "]"), "changes.0.time_s");
  EXPECT_EQ(refusal([] {
              Experiment::load("fig6.4",
                               {"renderer.name=tool-penalty",
                                "changes=[" + change("1", "renderer.stiffness_N_per_m", "2") + "]"});
            }),
            "changes.0.parameter = renderer.stiffness_N_per_m: this renderer has no live parameters");
}

TEST(RendererChanges, TimesDoNotGoBack) {
  EXPECT_EQ(
      why("[" + change("0.2", "renderer.r3_m", "0.02") + ", " + change("0.1", "renderer.r3_m", "0.03") + "]"),
      "changes.1.time_s = 0.1: expected the time of the change before it or later");
}

// r1 < r2 < r3 has to be true after all changes of one time, not between them.
TEST(RendererChanges, ChangesOfOneTimeAreCheckedTogether) {
  const std::string r1 = change("0.1", "renderer.r1_m", "0.00599"),
                    r2 = change("0.1", "renderer.r2_m", "0.00601");
  EXPECT_EQ(why("[" + r1 + "]"),
            "changes.0: after this change renderer.r1_m = 0.00599: expected below r2_m = 0.00501");
  EXPECT_EQ(lift("[" + r1 + ", " + r2 + "]").changes().size(), 2u);
}

// The first tick at or after 0.1001 s is that of 0.101 s at 1000 Hz; it makes both changes.
TEST(RendererChanges, RefusesTwoOfOneParameterInOneTick) {
  const auto two = [](const char* first_s, const char* second_s, const char* parameter) {
    return "[" + change(first_s, "renderer.stiffness_N_per_m", "100") + ", " +
           change("0.1001", "renderer.r3_m", "0.02") + ", " + change(second_s, parameter, "0.02") + "]";
  };
  constexpr const char* kStiffness = "renderer.stiffness_N_per_m";
  EXPECT_EQ(
      why(two("0.1001", "0.1001", kStiffness)),
      "changes.2.parameter = renderer.stiffness_N_per_m: changes.0 sets it in the same tick: expected one "
      "of them");
  EXPECT_HAS(why(two("0.1001", "0.101", kStiffness)), "changes.0 sets it in the same tick");
  EXPECT_HAS(why(two("0.1001", "0.101", "renderer.r3_m")), "changes.1 sets it in the same tick");
  EXPECT_EQ(why(two("0.1", "0.1001", kStiffness)), "no InputError");
  EXPECT_EQ(why(two("0.1001", "0.1011", kStiffness)), "no InputError");
}

// 1000 * 2.007 is rounded to a number above 2007, but the run changes the parameter at its tick 2007.
TEST(RendererChanges, AllowsOneParameterInSuccessiveTicks) {
  for (int tick = 2000; tick < 2050; ++tick) {
    const auto at = [](int number) {
      const std::string time_s = "2." + std::to_string(number).substr(1);
      return change(time_s.c_str(), "renderer.r3_m", "0.02");
    };
    EXPECT_EQ(why("[" + at(tick) + ", " + at(tick + 1) + "]"), "no InputError");
  }
}

TEST(RendererChanges, SurviveWritingAndReading) {
  const Experiment experiment = lift("[" + change("0.25", "renderer.velocity_estimate", "0") + "]");
  EXPECT_EQ(Experiment::from_json(experiment.to_json(), "again").to_json(), experiment.to_json());
}

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

// --- what they do ---

std::string digest_of(const Experiment& experiment) {
  return digest(simulate(experiment).columns());
}

TEST(RendererChanges, ChangesAtTimeZeroAreSettings) {
  for (const auto& [parameter, value, set] :
       {std::tuple("stiffness_N_per_m", "900", "900"), std::tuple("r3_m", "0.013", "0.013"),
        std::tuple("velocity_estimate", "0", "false")}) {
    const std::string name = std::string("renderer.") + parameter;
    EXPECT_EQ(digest_of(lift("[" + change("0", name, value) + "]")),
              digest_of(lift("[]", {name + "=" + set})))
        << name;
    EXPECT_NE(digest_of(lift("[" + change("0", name, value) + "]")), digest_of(lift())) << name;
  }
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

TEST(RendererChanges, ASpringTwiceAsStiffPushesTwiceAsHard) {
  const Trace plain = simulate(lift()),
              changed = simulate(lift("[" + change("0.65", "renderer.stiffness_N_per_m", "1200") + "]"));
  for (std::size_t tick = 650; tick < 800; ++tick) {
    EXPECT_EQ(changed.proxy_position_m[tick], plain.proxy_position_m[tick])
        << "the force does not move the proxy";
    EXPECT_NEAR((changed.force_N[tick] - 2 * plain.force_N[tick]).norm(), 0, 1e-9) << tick;
  }
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

}  // namespace
}  // namespace remote_touch::configuration_test
