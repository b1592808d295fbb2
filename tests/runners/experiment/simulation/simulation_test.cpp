// A run as a whole: its report, its main measures, its length, replayed contacts, and a simulated device.
#include "runners/experiment/simulation/simulation.h"

#include <gtest/gtest.h>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "tests/runners/experiment/simulation/reported_run.h"
#include "tests/support/test_files.h"

namespace remote_touch::simulation_test {
namespace {

constexpr const char* kPlane = R"({"name": "flat-grid", "rows": 40, "columns": 40, "spacing_m": 0.0015})";
constexpr const char* kPress =
    R"({"name": "press", "start_m": [0, 0.02, 0], "press_at_s": 0.1, "depth_m": 0.01})";

TEST(RunReport, AnOrdinaryPressHasNoNotes) {
  const RunReport report = run_of(kPlane, kPress).report;
  EXPECT_TRUE(report.notes.empty());
  EXPECT_TRUE(report.inputs.empty());  // no recording was read
  EXPECT_EQ(text_of(report), "");
  EXPECT_NO_THROW(refuse_notes(report));
}

TEST(RunReport, ReportsAPressThatWasNotReached) {
  const RunReport report = run_of(kPlane, kPress, R"("duration_s": 0.1)").report;
  EXPECT_EQ(kinds_of(report.notes), (Kinds{"phase not reached", "no contact"}));
  EXPECT_EQ(report.notes[0].text, "the run ends at 0.1 s, before the press begins at 0.1 s");
  EXPECT_HAS(text_of(report), "  note (phase not reached): the run ends at 0.1 s");
  EXPECT_EQ(refusal([&] { refuse_notes(report); }),
            "--strict: phase not reached: the run ends at 0.1 s, before the press begins at 0.1 s; "
            "no contact: no point was touched, and no force was felt")
      << "all notes";
}

// Each note is written for a run that did not do what its experiment describes, and for no other. A motion
// that never happens is neither missed nor over. The proxy falls through a square of points farther apart
// than sqrt(2) r_c = 7.07 mm; the centre of a square is 7.2 mm / sqrt(2) from its corners.
TEST(RunReport, HasNotesOnWhatDidNotHappen) {
  const std::string rising = R"({"name": "moving-plane", "wait_s": 0, "start_height_m": -0.01, )"
                             R"("speed_m_per_s": 0.2, "rise_height_m": 0.01})",
                    waits = R"({"name": "moving-plane", "start_height_m": 0, "wait_s": 0.4})",
                    rests = R"({"name": "moving-plane", "start_height_m": 0, "rise_height_m": 0, "wait_s": )",
                    spaced = R"({"name": "flat-grid", "rows": 41, "columns": 41, "spacing_m": )",
                    path = R"({"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.01, 0, 0.2]]})",
                    above = R"({"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, 0.01, 0, 0.3]]})";
  const struct {
    std::string scenario, trajectory, duration_s;
    Kinds kinds;
    const char* text;  // a part of the first note
  } rows[] = {
      {waits, kPress, "0.3", {"phase not reached"}, ""},
      {waits, kPress, "0.5", {}, ""},
      {rising,
       kPress,
       "0.3",
       {"after the motion"},
       "the press begins at 0.1 s, after the rise of the plane has ended at 0.05 s"},
      {rests + "5}", kPress, "0.3", {}, ""},
      {rests + "0}", kPress, "0.3", {}, ""},
      {kPlane, path, "0.3", {}, ""},
      {kPlane, path, "0.14", {"phase not reached"}, ""},
      {kPlane, above, "0.3", {"no contact"}, ""},
      {spaced + "0.0069}", kPress, "0.3", {}, ""},
      {spaced + "0.0072}", kPress, "0.3", {"wide spacing"}, "a gap of radius 5.09 mm at the first contact"}};
  for (const auto& row : rows) {
    const ReportedRun run = run_of(row.scenario, row.trajectory, R"("duration_s": )" + row.duration_s);
    ASSERT_EQ(run.kinds(), row.kinds) << row.scenario << row.trajectory << row.duration_s;
    if (!row.kinds.empty()) {
      EXPECT_HAS(run.report.notes[0].text, row.text);
    }
  }
}

// The plane rises from the start on; the run shows it in two frames at 2 Hz and in one at 0.5 Hz.
TEST(RunReport, ReportsAMotionThatFewFramesShow) {
  const auto lift = [](const std::string& rate_hz, const std::string& more = "") {
    return R"({"name": "moving-lift", "rows": 41, "columns": 41, "noise_sigma_m": 0, "frame_rate_hz": )" +
           rate_hz + more + "}";
  };
  const char* const rest = R"({"name": "waypoints", "waypoints": [[0, 0, 0, 0]]})";
  const auto noted = [&](const std::string& scene, const std::string& duration_s) {
    return run_of(scene, rest, R"("duration_s": )" + duration_s).has("few frames");
  };
  EXPECT_TRUE(noted(lift("2"), "0.8"));
  EXPECT_FALSE(noted(lift("5"), "0.8"));
  EXPECT_FALSE(noted(lift("30"), "0.05")) << "the run is cut short";
  EXPECT_FALSE(noted(lift("0.5", R"(, "start_velocity_m_per_s": 0, "acceleration_m_per_s2": 0)"), "0.8"))
      << "the scene is at rest";
  EXPECT_HAS(text_of(run_of(lift("0.5"), rest, R"("duration_s": 0.8)").report),
             "note (few frames): 1 frame in the 0.8 s in which the scene moves: its motion");
  const std::string jumps =
      R"({"name": "moving-plane", "start_height_m": -0.01, "wait_s": 0, "speed_m_per_s": 1, "rise_height_m": 0.01})";
  EXPECT_FALSE(noted(jumps, "0.8")) << "a brief motion";
}

// Every event that the run does not reach is named once: a rule that never begins, a change, a press of a
// button and others.
TEST(RunReport, ReportsEveryTimeThatTheRunDoesNotReach) {
  const std::string still = R"({"name": "waypoints", "waypoints": [[0, 0.003, 0, 0], [0, 0.003, 0, 0.1]]})";
  const std::string plates = R"({"name": "plates", "plates": [[0, 0, 0, 0.2, 0.2, 0.1, 0, 2, 3],
      [0, -0.1, 0, 0.2, 0.2, 0, 0, 4, 5], [0, -0.1, 0, 0.2, 0.2, 0.1, 0, 5, 5]]})";
  const std::string change = R"({"parameter": "renderer.stiffness_N_per_m", "value": 100, "time_s": )";
  const std::string step = R"({"action": "wait", "not_before_s": 3})";
  const struct {
    std::string scenario, rest;
    std::vector<std::string> begins;
  } runs[] = {
      {kPlane,
       R"("changes": [)" + change + "0.1}, " + change + "5}, " + change + "6}]",
       {"the change of renderer.stiffness_N_per_m begins at 5 s"}},
      {kPlane,
       R"("fixtures": [{"name": "everywhere", "radius_m": 0.01, "schedule": [[0, 1], [7, 1], [8, 0]]}])",
       {"the change of the strength of fixtures.0 begins at 7 s"}},
      {kPlane, R"("fixtures": [{"name": "everywhere", "radius_m": 0.01, "schedule": [[0, 1], [8, 0]]}])", {}},
      {kPlane,
       R"("operator": {"presses": [[0.1, 0, 0.1], [3, 1, 0.2]], "grip": [[0, 1], [2, 1], [3, 0]]})",
       {"the press of button 1 begins at 3 s", "the change of operator.grip begins at 2 s"}},
      {kPlane, R"("sequence": [{"action": "wait"}, )" + step + "]", {"sequence.1 (wait) begins at 3 s"}},
      {R"({"name": "moving-shape", "vanish_at_s": 2})", "", {"the vanishing of the surface begins at 2 s"}},
      {R"({"name": "moving-shape", "vanish_at_s": 0.2})", "", {}},
      {R"({"name": "moving-shape", "empty_frame_at_s": 2})", "", {"the empty frame begins at 2 s"}},
      {plates, "", {"the motion of plate 1 begins at 2 s"}},
      {R"({"name": "wedge"})",
       "",
       {"the closing of the walls begins at 1 s", "the opening of the walls begins at 3 s"}},
      {R"({"name": "wedge", "closed_gap_m": 0.05})", "", {}},
      {R"({"name": "wedge", "close_start_s": 4, "close_end_s": 4, "open_start_s": 4, "open_end_s": 4})",
       "",
       {}},
  };
  for (const auto& run : runs) {
    const std::string rest = R"("duration_s": 0.3)" + (run.rest.empty() ? "" : ", " + run.rest);
    std::vector<std::string> begins;
    for (const Note& note : run_of(run.scenario, still, rest).report.notes)
      if (note.kind == "phase not reached") begins.push_back(note.text.substr(note.text.find("before ") + 7));
    EXPECT_EQ(begins, run.begins) << run.scenario << run.rest;
  }
}

TEST(RunReport, BecomesAttributesOfTheResult) {
  TextAttributes attributes{{"config", "{}"}};
  add_report(attributes, {});
  EXPECT_EQ(attributes.size(), 1u);  // absent where there is nothing to report
  add_report(attributes, {{"office: 3 frames"}, {{"no contact", "no contact at all"}, {"no frame", "none"}}});
  EXPECT_EQ(attribute(attributes, "frames_read"), "office: 3 frames");
  EXPECT_EQ(attribute(attributes, "notes"), "no contact at all\nnone");
}

using Names = std::vector<std::string>;

Trace run(const std::string& experiment, std::vector<std::string> settings) {
  SimulationOptions options;
  options.find_true_contact = true;
  settings.emplace_back("duration_s=0.8");
  return simulate(Experiment::load(experiment, settings), options);
}

Names main_names(const Trace& trace, Fixtures fixtures) {
  Names names;
  for (const auto& [measure, value] : main_measures(measured_values(built_in_measures(), trace), fixtures)) {
    EXPECT_FALSE(std::isnan(value)) << measure->name;
    names.push_back(measure->name);
  }
  return names;
}

// The true surface is first, the contact of a slave, or the torque of a tool.
TEST(MainMeasures, AreThoseOfTheKindOfRun) {
  const struct {
    const char* experiment;
    Fixtures fixtures;
    Names names;
  } rows[] = {
      {"fig4.12",
       Fixtures::none,
       {"popped_through", "max_penetration", "rms_contact_error", "max_force", "max_force_jump"}},
      {"fig4.12",
       Fixtures::some,
       {"min_slave_distance", "max_force", "max_force_jump", "force_fraction", "unconverged_fraction"}},
      {"steer-robot",
       Fixtures::some,
       {"max_slave_force", "min_slave_clearance", "max_device_force", "min_slave_distance", "max_force"}},
      {"tool-lift",
       Fixtures::none,
       {"tool_popped_through", "max_tool_penetration", "max_force", "max_force_jump", "max_torque"}}};
  for (const auto& row : rows)
    EXPECT_EQ(main_names(run(row.experiment, {}), row.fixtures), row.names) << row.experiment;
  Trace guided;
  RenderOutput out;
  out.guidance.emplace().active = true;
  out.guidance->goal_W = Vec3(0.01, 0, 0);
  guided.append(0, {}, out, {0.01, 0.01, 0});
  EXPECT_EQ(main_names(guided, Fixtures::some).at(1), "guidance_error");
}

TEST(MainMeasures, HaveOthersIfTheTruthIsUnknown) {
  Trace trace = run("fig4.12", {});
  for (double& distance_m : trace.signed_distance_m) distance_m = std::nan("");
  trace.contact.clear();
  EXPECT_EQ(main_names(trace, Fixtures::none),
            (Names{"max_force", "max_force_jump", "force_fraction", "unconverged_fraction", "mean_steps"}));
}

TEST(MainMeasures, HaveAllThatAreNotBuiltIn) {
  const Trace trace = run("fig4.12", {});
  std::vector<Measure> list = built_in_measures();
  list.push_back({"mine", "N/s", "my own", MeasuredRuns::all, [](const Trace&) { return 41.0; }});
  const std::vector<MeasuredValue> all = measured_values(list, trace);
  const std::vector<MeasuredValue> chosen = main_measures(all, Fixtures::none);
  ASSERT_EQ(chosen.size(), 6u);
  EXPECT_EQ(chosen.back().measure->name, "mine");
  EXPECT_EQ(chosen.back().value, 41);
}

TEST(UnitInWords, NamesEveryUnitOfTheBuiltInMeasures) {
  for (const Measure& measure : built_in_measures())
    EXPECT_NE(unit_in_words(measure.unit), measure.unit) << measure.name;
  EXPECT_EQ(unit_in_words("m"), "metres");
  EXPECT_EQ(unit_in_words("1"), "");
  EXPECT_EQ(unit_in_words("N/s"), "N/s");
}

// --- the number of ticks ---

Trace run_for(const std::string& duration_s) {
  return simulate(Experiment::load("fig4.11", {"duration_s=" + duration_s}));
}

// Sums of times carry rounding errors: 0.1 + 0.1 + 0.1 is above 0.3. An excess of a millionth of a tick
// counts as rounding.
TEST(RunLength, RoundingOfTheDurationAddsNoTick) {
  static_assert(0.1 + 0.1 + 0.1 > 0.3);
  for (const char* duration_s : {"0.3", "0.30000000000000004", "0.2999999999999999", "0.3000000005"}) {
    const Trace trace = run_for(duration_s);
    EXPECT_EQ(trace.length(), 300u) << duration_s;
    EXPECT_EQ(trace.time_s.back(), 0.299) << duration_s;
  }
}

TEST(RunLength, APartOfATickCountsAsATick) {
  EXPECT_EQ(run_for("0.30000001").length(), 301u);  // a hundred-thousandth of a tick more
  EXPECT_EQ(run_for("0.3009").length(), 301u);
  EXPECT_EQ(run_for("0.00001").length(), 1u);
  EXPECT_HAS(refusal([] { run_for("0.0000000005"); }), "shorter than a tick");
}

// --- replayed contacts: renderers whose error is known ---

Trace replayed(const std::string& renderer, const std::vector<std::string>& settings = {}) {
  const std::string text = R"({"scenario": {"name": "moving-shape"}, "trajectory": {"name": "contact-replay"},
                               "renderer": {"name": ")" +
                           renderer + R"("}})";
  SimulationOptions options;
  options.find_true_contact = true;
  return simulate(Experiment::from_json(text, "test", settings), options);
}

// The mesh of a flat grid is the plane itself, and a god-object stays surface_offset_m = 1e-5 m above it.
TEST(ContactReplayLoop, AGodObjectOnAPlaneHasNoError) {
  const Trace trace = replayed("god-object", {"trajectory.onset_distance_m=1e-5"});
  ASSERT_TRUE(trace.has_replay());
  EXPECT_LT(rms_force_error_N(trace), 0.001);
  EXPECT_LT(force_direction_error_rad(trace), 1e-6);
  EXPECT_EQ(false_contact_fraction(trace), 0);
  EXPECT_EQ(lost_contact_fraction(trace), 0);
}

TEST(ContactReplayLoop, OtherRunsHaveNoExpectedForce) {
  EXPECT_FALSE(replayed("proxy", {"operator={}", "duration_s=0.1"}).has_replay());
  EXPECT_TRUE(replayed("proxy", {"device={}", "duration_s=0.1"}).has_replay());
  EXPECT_FALSE(replayed("proxy", {R"(trajectory={"name": "waypoints"})", "duration_s=0.1"}).has_replay());
}

// --- a simulated device that rounds, delays, rubs and damps ---

Trace run_on_device(std::vector<std::string> overrides) {
  overrides.push_back("duration_s=1.2");
  return simulate(Experiment::load("fig4.11", overrides));
}

constexpr const char* kOperator = R"(operator={"stiffness_N_per_m": 300, "damping_Ns_per_m": 15})";

TEST(DeviceRun, RecordsTheTruePoseOnlyIfTheDeviceRoundsIt) {
  EXPECT_FALSE(run_on_device({"device={}"}).has_rounded_hand());
  const Trace trace = run_on_device({R"(device={"position_resolution_m": 0.001})"});
  ASSERT_TRUE(trace.has_rounded_hand());
  double largest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 steps = trace.hip_position_m[i] / 0.001;
    EXPECT_NEAR((steps - Vec3(steps.array().round())).norm(), 0, 1e-9) << i;
    largest = std::max(largest, (trace.hip_position_m[i] - trace.hand_position_m[i]).cwiseAbs().maxCoeff());
    EXPECT_EQ(trace.hand_position_m[i], trace.intended_position_m[i]) << i;
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LE(largest, 0.0005 + 1e-12);
}

// The device exerts the damped force of five ticks before, and damps only where there is a force.
TEST(DeviceRun, ExertsAndDampsTheForceOfEarlierTicks) {
  const Trace trace = run_on_device(
      {kOperator, R"(device={"delay_ticks": 5, "contact_damping_Ns_per_m": 3, "velocity_ticks": 4})"});
  std::size_t damped = 0;
  for (std::size_t i = 9; i < trace.length(); ++i) {
    const std::size_t then = i - 5;
    const Vec3 added = trace.device_force_N[i] - trace.force_N[then];
    if (trace.force_N[then].isZero(0)) {
      EXPECT_TRUE(added.isZero(0)) << i;
      continue;
    }
    const Vec3 velocity = (trace.hip_position_m[then] - trace.hip_position_m[then - 4]) / 0.004;
    EXPECT_NEAR((added + 3 * velocity).norm(), 0, 1e-9) << i;
    damped += added.norm() > 1e-6;
  }
  EXPECT_GT(damped, 50u);
}

// A spring that pulls less than friction does not move the hand from its first position.
TEST(DeviceRun, FrictionHoldsTheHand) {
  // The path jumps, and a damper would pull with the speed of the jump.
  const Trace held =
      run_on_device({kOperator, "operator.damping_Ns_per_m=0", R"(device={"friction_N": 100})"});
  EXPECT_EQ(held.hip_position_m.back(), held.hip_position_m.front());
  EXPECT_GT((held.intended_position_m.back() - held.hip_position_m.back()).norm(), 0.01);
  const Trace rubbed = run_on_device({kOperator, R"(device={"friction_N": 0.5})"});
  const Trace smooth = run_on_device({kOperator, "device={}"});
  EXPECT_NE(rubbed.hip_position_m.back(), smooth.hip_position_m.back());
  EXPECT_NEAR((rubbed.hip_position_m.back() - smooth.hip_position_m.back()).norm(), 0,
              2 * std::sqrt(3) * 0.5 / 300);
}

}  // namespace
}  // namespace remote_touch::simulation_test
