// Refusals of an experiment, each in one line: settings that contradict each other, unknown keys, and other
// text. What is mistyped most often is refused in the test command_line/refusals.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/runners/experiment/catalog/whole_experiments.h"
#include "tests/support/test_files.h"

namespace remote_touch::experiment_refusals_test {
namespace {

// A refusal of a stored experiment, or of one of whole_experiments.h, with these overrides.
struct Row {
  const char* experiment;
  std::vector<std::string> set;
  std::string expected;
};

Row row(const char* experiment, std::vector<std::string> set, std::string expected) {
  return {experiment, std::move(set), std::move(expected)};
}

std::string why(const std::string& experiment, const std::vector<std::string>& set) {
  return refusal([&] {
    if (experiment.starts_with("{"))
      Experiment::from_json(experiment, "file.json", set);
    else
      Experiment::load(experiment, set);
  });
}

void expect_refused(const std::vector<Row>& rows) {
  for (const Row& row : rows) EXPECT_HAS(why(row.experiment, row.set), row.expected);
}

const std::string kNone = "no InputError";

TEST(ExperimentRefusals, OverridesAndPartsOfAnotherShape) {
  expect_refused(
      {row(kSmall, {"renderer.=3"}, "renderer"),
       row(kSmall, {"renderer.xi=" + std::string(1000, '[')}, "renderer.xi"),
       row(kSmall, {"renderer.xi=" + std::string(1000, '[') + std::string(1000, ']')}, "renderer.xi"),
       row(kSmall, {"scenario=3"}, "scenario = 3: not an object: expected {\"name\": ..., parameters}"),
       row(kSmall, {"scenario.name=3"}, "scenario.name = 3: expected a name from `remote-touch list`"),
       row(kSmall, {R"(scenario={"name":"recording"})"}, "scenario.path"),
       row(kSmall, {"fixtures=[null]"}, "fixtures.0: missing: expected {\"name\""),
       row(kTask, {"fixtures.1.normal=[0,0,0]"}, "fixtures.1.normal: expected longer than 0"),
       row(kTask, {R"(sequence={"action": "wait"})"},
           "sequence: expected a list of {\"action\": ..., parameters}"),
       row(kTask, {"sequence=[3]"}, "sequence.0: expected an object of parameters"),
       row(kTask, {"device=[]"}, "device: expected an object of parameters"),
       row("fig4.12", {"faults.view_direction=[0,0,0]"},
           "faults.view_direction: expected a vector of length 0.001 or more"),
       row(kTask, {"safety.force_slew_N_per_s=100"}, "safety.force_slew_N_per_s = 100")});
}

// Sections are searched together with the parameters of the run. A key without its section is named with it.
TEST(ExperimentRefusals, UnknownKeysWithTheNearest) {
  expect_refused(
      {row("fig4.11", {"fixturs=3"}, "fixturs: unknown; did you mean fixtures"),
       row("fig4.11", {"saftey.ramp_s=3"}, "did you mean safety"),
       row("fig4.11", {"renderer.nam=proxy"}, "did you mean renderer.name"),
       row("fig4.11", {"run.seed=3"}, "run: unknown"),
       row("fig4.11", {"spacing_m=0.001"}, "spacing_m: unknown; did you mean scenario.spacing_m"),
       row("fig4.12", {"scenario.name=flat-grid"},
           "scenario.acceleration_m_per_s2: flat-grid has no such parameter: expected --set "
           "'scenario={\"name\": \"flat-grid\"}', which replaces the whole object"),
       row("fig4.12", {"scenario.name=flat-grid", "scenario.x_m=1"}, "flat-grid has no such parameter"),
       row("fig4.12", {"scenario={\"name\": \"flat-grid\"}"}, kNone)});
  for (const ExperimentSection& section : experiment_sections()) {
    const bool is_list = Json::parse(kAll).value(section.key, Json()).is_array();
    const std::string path = section.is_top_level ? "" : std::string(section.key) + (is_list ? ".0." : ".");
    EXPECT_TRUE(why(kAll, {path + "moon_px=3"}).starts_with(path + "moon_px: unknown; did you mean " + path))
        << path;
  }
}

TEST(ExperimentRefusals, WhatIsNoSection) {
  for (const ExperimentSection& section : experiment_sections()) {
    const std::string key = section.key;
    if (section.is_top_level) {
      EXPECT_TRUE(why(kAll, {key + "=3"}).starts_with(key + ": unknown; did you mean ")) << key;
      continue;
    }
    for (const char* value : {"3", "text", "true", "[3]"}) {
      const std::string message = why(kAll, {key + "=" + value});
      EXPECT_TRUE(message.starts_with(key)) << message;
      EXPECT_HAS(message, "expected ");
    }
  }
}

TEST(ExperimentRefusals, TasksThatDoNotFitTheirFixturesOrButtons) {
  expect_refused(
      {row(kTask, {"fixtures.1.radius_m=-1"}, "expected above 0 for role = guidance"),
       row(kTask, {"guidance.approach_axis=[0,0,0]"},
           "guidance.approach_axis: expected a vector of length 0.001 or more"),
       row(kTask, {"fixtures.1.role=forbidden", "sequence=[]"},
           "guidance: expected only when a fixture has role = guidance"),
       row(kTask, {"sequence.0.fixture="}, "sequence.0.fixture = \"\": expected the label of a fixture"),
       row(kTask, {"sequence.2.fixture=valve"}, "sequence.2.fixture = \"valve\": expected none for wait"),
       row(kTask, {"sequence.1.fixture=knob"},
           "sequence.1.fixture = \"knob\": expected the label of a fixture: \"table\", \"valve\""),
       row(kTask, {"fixtures.1.label=table"},
           "fixtures.1.label = \"table\": expected a label of its own, fixtures.0 has this one"),
       row(kTask, {"fixtures.0.label=", "fixtures.1.label=", "sequence=[]"}, kNone),  // they are not mixed up
       row(kTask, {"sequence.0.fixture=valve"},
           "sequence.0.action = \"lock\": expected activate, release, wait for a fixture with role = guidance"),
       row(kTask, {R"(sequence.2={"action": "wait", "done": "reached", "fixture": "table"})"},
           "sequence.2.action = \"wait\": expected lock, unlock for a fixture with role = forbidden"),
       row(kTask, {"sequence.2.button=3"},
           "sequence.2.button = 3: expected a button of operator.presses (any button in experiments with a "
           "section live)"),
       row(kTask, {"operator=null"}, "sequence.1.button = 2: expected a button of operator.presses"),
       row(kTask, {"operator=null", "live={}"}, kNone),          // a real device has buttons
       row(kTask, {R"(sequence=[{"action": "wait"}])"}, kNone),  // presses may be unused
       row(kTask, {"sequence=[]", R"(fixtures.0={"name": "everywhere", "role": "guidance"})"},
           "fixtures.1.role = guidance: expected at most once among fixtures that no step of a sequence "
           "activates or releases"),
       row(kTask, {"sequence.0.offset_m=[0,0,1]"},
           "sequence.0.offset_m: expected 0 unless action = activate"),
       row(kTask, {"sequence.0.deadline_s=1"},
           "sequence.0.deadline_s = 1.000000: expected 0 for done = immediately")});
}

TEST(ExperimentRefusals, MoreFixturesThanATaskCanSwitch) {
  Json json = Json::parse(kTask);
  while (json["fixtures"].size() < 64) json["fixtures"].push_back({{"name", "everywhere"}});
  EXPECT_NO_THROW(Experiment::from_json(json));
  json["fixtures"].push_back({{"name", "everywhere"}});
  EXPECT_EQ(refusal([&] { Experiment::from_json(json); }),
            "fixtures: 65 rules: expected 64 or fewer with a sequence");
  json.erase("sequence");
  EXPECT_NO_THROW(Experiment::from_json(json));
}

TEST(ExperimentRefusals, ADeviceThatNeedsAHandWithAMass) {
  for (const std::string name :
       {"friction_N", "friction_torque_Nm", "damping_Ns_per_m", "rotational_damping_Nms_per_rad"})
    expect_refused(
        {row(kTask, {"device." + name + "=0.5"}, kNone),
         row("fig4.11", {"device." + name + "=0.5"},
             "device." + name + " = 0.5: expected 0 in an experiment without the section operator")});
  expect_refused({row(kTask, {"device.velocity_ticks=2"}, "device.velocity_ticks = 2: expected 1 without"),
                  row(kTask, {"device.velocity_ticks=2", "device.contact_damping_Ns_per_m=1"}, kNone)});
}

// The size of a position depends on the origin of the world frame. Passivity control and waves would balance
// another motion than the hand has; they know the limit of a force. A slave with a tool couples no rotation
// to them.
TEST(ExperimentRefusals, SlavesThatCannotBeRun) {
  const std::string relative =
      "command_link.weber_fraction = 0.1: expected 0, and a length as command_link.least: the size of a "
      "position depends on the origin";
  expect_refused(
      {row(kAll, {"command_link.weber_fraction=0.1"}, relative),
       row("steer-robot", {"command_link.weber_fraction=0.1", "command_link.least=0.001"}, relative),
       row(kAll, {"force_link.weber_fraction=0.1"}, kNone),
       row("steer-robot", {"slave=null", "command_link.delay_s=1"},
           "command_link: expected only in an experiment with the section slave"),
       row("steer-tool", {"slave.radius_m=0.01"}, "slave.radius_m = 0.01")});
  for (const std::string force : {"passive-slave-force", "wave"}) {
    const std::string feedback = "feedback.force=" + force;
    for (const char* device : {"{}", R"({"friction_N": 0.1})", R"({"max_force_N": 2})"})
      EXPECT_EQ(why("steer-robot", {feedback, std::string("device=") + device}), kNone) << device;
    for (const char* device : {R"({"force_y": false})", R"({"position_resolution_m": 5e-5})",
                               R"({"delay_ticks": 1})", R"({"contact_damping_Ns_per_m": -1})"})
      EXPECT_HAS(why("steer-robot", {feedback, std::string("device=") + device}),
                 "expected the default with feedback.force = " + force)
          << device;
  }
  for (const std::string force : {"passive-slave-force", "position-position", "wave"})
    EXPECT_HAS(why("steer-tool", {"feedback.force=" + force}),
               "feedback.force = " + force + ": expected another");
}

TEST(ExperimentRefusals, WhatAnArchitectureCannotUse) {
  const struct {
    const char *force, *setting;
    std::string expected;
  } rows[] = {{"wave", "command_link.least=0.001", "command_link.least = 0.001"},
              {"wave", "force_link.weber_fraction=0.1", "force_link.weber_fraction = 0.1"},
              {"position-position", "force_link.least=0.1", "which needs every packet"},
              {"position-position", "command_link.least=0.001", kNone},
              {"wave", "slave.max_speed_m_per_s=0.2", "slave.max_speed_m_per_s = 0.2: expected 0"},
              {"wave", "feedback.gain=0.5", "expected 1 unless force = slave-force"},
              {"slave-force", "feedback.impedance_Ns_per_m=20", "expected 0 unless force = wave"},
              {"wave", "feedback.stiffness_N_per_m=300", "expected 600 unless force = position-position"}};
  for (const auto& row : rows)
    EXPECT_HAS(why("steer-robot", {std::string("feedback.force=") + row.force, row.setting}), row.expected)
        << row.force;
}

// --- changes of the renderer ---

std::string change(const std::string& time_s, const std::string& parameter, const std::string& value) {
  return R"({"time_s": )" + time_s + R"(, "parameter": "renderer.)" + parameter + R"(", "value": )" + value +
         "}";
}
std::string why_not(const std::string& changes, const std::string& experiment = "fig4.12") {
  return why(experiment, {"changes=[" + changes + "]"});
}

// r1 < r2 < r3 has to be true after all changes of one time, not between them. The first tick at or after
// 0.1001 s is that of 0.101 s at 1000 Hz; two changes of one parameter there are refused.
TEST(ExperimentRefusals, ChangesThatCannotBeMade) {
  const std::string r1 = change("0.1", "r1_m", "0.00599"), r2 = change("0.1", "r2_m", "0.00601");
  const auto two = [](const char* first_s, const char* second_s, const char* parameter) {
    return change(first_s, "stiffness_N_per_m", "100") + ", " + change("0.1001", "r3_m", "0.02") + ", " +
           change(second_s, parameter, "0.02");
  };
  const std::pair<std::string, std::string> rows[] = {
      {change("0.1", "gamma", "0.2"),
       "changes.0.parameter = renderer.gamma: expected one of renderer.r1_m, renderer.r2_m, renderer.r3_m, "
       "renderer.stiffness_N_per_m, renderer.velocity_estimate"},
      {change("0.1", "stiffness_N_per_m", "10001"),
       "changes.0.value = 10001.0: expected 0 to 10000, the range of renderer.stiffness_N_per_m"},
      {change("0.1", "velocity_estimate", "0.5"),
       "changes.0.value = 0.5: expected 0 or 1, the range of renderer.velocity_estimate"},
      {change("-1", "r3_m", "0.02"), "changes.0.time_s"},
      {change("0.2", "r3_m", "0.02") + ", " + change("0.1", "r3_m", "0.03"),
       "changes.1.time_s = 0.1: expected the time of the change before it or later"},
      {r1, "changes.0: after this change renderer.r1_m = 0.00599: expected below r2_m = 0.00501"},
      {r1 + ", " + r2, kNone},
      {two("0.1001", "0.1001", "stiffness_N_per_m"),
       "changes.2.parameter = renderer.stiffness_N_per_m: changes.0 sets it in the same tick: expected one "
       "of them"},
      {two("0.1001", "0.101", "r3_m"), "changes.1 sets it in the same tick"},
      {two("0.1", "0.1001", "stiffness_N_per_m"), kNone},
      {two("0.1001", "0.1011", "stiffness_N_per_m"), kNone}};
  for (const auto& [changes, expected] : rows) EXPECT_HAS(why_not(changes), expected);
  EXPECT_EQ(why("fig6.4",
                {"renderer.name=tool-penalty", "changes=[" + change("1", "stiffness_N_per_m", "2") + "]"}),
            "changes.0.parameter = renderer.stiffness_N_per_m: this renderer has no live parameters");
}

// 1000 * 2.007 is rounded to a number above 2007, but the run changes the parameter at its tick 2007.
TEST(ExperimentRefusals, AllowChangesInSuccessiveTicks) {
  for (int tick = 2000; tick < 2050; ++tick) {
    const auto at = [](int number) {
      return change("2." + std::to_string(number).substr(1), "r3_m", "0.02");
    };
    EXPECT_EQ(why_not(at(tick) + ", " + at(tick + 1)), kNone);
  }
}

// --- text that is no experiment ---

TEST(ExperimentRefusals, TextThatIsNoExperiment) {
  const auto why_text = [](const std::string& text) {
    return refusal([&] { Experiment::from_json(text, "file.json"); });
  };
  for (const char* text : {"", "{\"seed\": 1e999}", "nonsense", "{} {}", "\xff"})
    EXPECT_HAS(why_text(text), "file.json: ") << text;
  for (const char* text : {"3", "null", "\"text\""})
    EXPECT_HAS(why_text(text), "file.json: not an object") << text;
  EXPECT_HAS(why_text(std::string(100000, '[')), "file.json: nested too deep");
  EXPECT_HAS(why_text(R"({"scenario": {"columns": 3}})"), "scenario: missing");
  EXPECT_EQ(why_text(R"({"experiment": "fig4.12", "axes": []})"),
            "file.json: is a sweep: expected `remote-touch sweep file.json -o FILE`");
}

// An error in a file begins with its name, unless an override made it. This holds even if the text of the
// file is wrong.
TEST(ExperimentRefusals, NameTheFileOrTheOverride) {
  const TestFolder folder("experiment_refusals_test");
  const std::string file = (folder / "mine.json").string();
  const std::string wrong = R"({"scenario": {"name": "flat-grid", "spacing_m": 7}, )"
                            R"("renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"}})";
  const struct {
    std::string text, assignment, begins;
  } rows[] = {{wrong, "seed=9", file + ": scenario.spacing_m = 7: expected "},
              {wrong, "scenario.spacing_m=0.002", kNone},
              {"{}", "seed=9", file + ": scenario: missing"},
              {kSmall, "scenario.spacing_m=7", "scenario.spacing_m = 7: expected "},
              {kSmall, "renderer.r1_m=0.0051", "renderer.r1_m = "},
              {"{}", "scenario=3", "scenario = 3: "},
              {"{}", "=3", "--set =3: "},
              {R"({"seed": 3})", "seed.x=1", "--set seed.x=1: "}};
  for (const auto& row : rows) {
    folder.write("mine.json", row.text);
    const std::string message = refusal([&] { Experiment::load(file, {row.assignment}); });
    EXPECT_TRUE(message.starts_with(row.begins)) << row.text << " " << row.assignment << ": " << message;
  }
}

TEST(ExperimentRefusals, EntriesOfTheCatalogWithoutAFreeAndPlainName) {
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
}  // namespace remote_touch::experiment_refusals_test
