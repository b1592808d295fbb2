// The whole loop: a task, guidance, a hand that feels it and a device that lacks a motor, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/analysis/trace/measure_named.h"

namespace remote_touch::guided_loop_test {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

// --- regions ---

// One point with a region of 2 cm, and a hand that rests 1.5 cm beside it.
Trace beside_a_ball(const std::string& sequence) {
  return simulate(Experiment::from_json(R"({"duration_s": 1.5,
      "scenario": {"name": "points", "points": [[0, 0, 0]], "frame_rate_hz": 30},
      "fixtures": [{"name": "everywhere", "radius_m": 0.02, "label": "ball"}],
      "sequence": )" + sequence + R"(, "renderer": {"name": "proxy"},
      "trajectory": {"name": "waypoints", "waypoints": [[0, 0.015, 0, 0]]}})",
                                        "test"));
}

// Frames come at n / 30 s, before the tick of that time. A change that a tick makes takes effect with the
// next frame.
TEST(GuidedLoop, RegionsAreSwitchedWithTheNextFrame) {
  const Trace trace = beside_a_ball(R"([{"action": "lock", "fixture": "ball", "not_before_s": 0.5},
                    {"action": "unlock", "fixture": "ball", "not_before_s": 1.0}])");
  ASSERT_EQ(trace.length(), 1500u);
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const double force_N = trace.force_N[i].norm();
    // Unlocked from the beginning; frame 16 comes at 533.3 ms, frame 31 at 1033.3 ms.
    if (i <= 533 || i >= 1100) {
      ASSERT_EQ(force_N, 0) << i;
    } else if (i >= 600 && i <= 1033) {
      ASSERT_GT(force_N, 0.1) << i;
    }
    ASSERT_EQ(trace.sequence_step[i], i < 500 ? 0 : i < 1000 ? 1 : 2) << i;
  }
  EXPECT_EQ(trace.frame_index[533], 15);
  EXPECT_GT(trace.force_N[534].norm(), 0);
}

TEST(GuidedLoop, ARegionThatIsUnlockedFirstBeginsLocked) {
  const Trace trace = beside_a_ball(R"([{"action": "unlock", "fixture": "ball", "not_before_s": 0.5}])");
  EXPECT_GT(trace.force_N[100].norm(), 0.1);
  EXPECT_GT(trace.force_N[533].norm(), 0.1);
  EXPECT_EQ(trace.force_N[600].norm(), 0);
}

// --- guidance ---

// A penalty force holds the hand where the surface does, however guidance pulls at it.
TEST(GuidedLoop, GuidanceIsNoPartOfTheContact) {
  SimulationOptions options;
  options.find_true_contact = true;
  std::vector<double> errors_m, heights_m, jumps_N;
  for (const char* pull : {"0", "0.05", "0.096"}) {
    const Trace trace =
        simulate(Experiment::from_json(R"({"scenario": {"name": "flat-grid", "columns": 60, "rows": 60},
            "renderer": {"name": "penalty"}, "duration_s": 0.6,
            "trajectory": {"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.0005, 0, 0.1]]},
            "fixtures": [{"name": "near-point", "role": "guidance", "stiffness_N_per_m": 100}],
            "guidance": {"offset_m": [0, )" +
                                           std::string(pull) + R"(, 0], "max_force_N": 20}})",
                                       "test"),
                 options);
    EXPECT_TRUE(trace.guidance_active.back());
    const auto of = [&](const char* name) { return value_of(measure_named(name), trace); };
    errors_m.push_back(of("rms_contact_error")), heights_m.push_back(of("mean_distance"));
    jumps_N.push_back(of("force_fraction"));
  }
  for (const std::vector<double>& values : {errors_m, heights_m, jumps_N}) {
    EXPECT_FALSE(std::isnan(values[0]));
    for (const double value : values) EXPECT_NEAR(value, values[0], 1e-9);
  }
}

// The goal is 5 cm above the middle of a flat grid. The hand intends to be 2 cm beside it.
Trace beside_a_goal(const std::vector<std::string>& overrides, double duration_s = 4) {
  std::vector<std::string> all{"duration_s=" + std::to_string(duration_s)};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return simulate(Experiment::from_json(R"({"scenario": {"name": "flat-grid", "columns": 10, "rows": 10},
      "fixtures": [{"name": "everywhere", "role": "guidance", "label": "valve", "radius_m": 0.005}],
      "guidance": {"approach_axis": [0, -1, 0], "standoff_m": 0.05},
      "operator": {}, "renderer": {"name": "proxy"},
      "trajectory": {"name": "waypoints", "waypoints": [[0.02, 0.05, 0, 0]]}})",
                                        "test", all));
}

Trace of_a_tool(const std::string& rotation_deg, const std::vector<std::string>& overrides) {
  std::vector<std::string> all{
      R"(renderer={"name": "tool", "tool_mesh": "ball"})",
      // A tool needs normals.
      R"(scenario={"name": "moving-plane", "columns": 10, "rows": 10, "start_height_m": 0,
                                            "wait_s": 100})",
      "trajectory.waypoints=[[0,0.5,0,0]]", "guidance.rotation_deg=" + rotation_deg,
      // The goal stays where it is when the tool's axes turn.
      "guidance.standoff_m=0", "guidance.offset_m=[0,0.5,0]"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return beside_a_goal(all);
}

// Two springs in a row: 300 N/m to the intended position, 200 N/m to the goal.
TEST(GuidedLoop, HandAndGuidanceMeetWhereTheirSpringsAreEven) {
  const Trace trace = beside_a_goal({});
  const std::size_t end = trace.length() - 1;
  EXPECT_LT((trace.guidance_goal_m[end] - Vec3(0, 0.05, 0)).norm(), 1e-12);
  EXPECT_LT((trace.hip_position_m[end] - Vec3(0.02 * 300 / 500, 0.05, 0)).norm(), 1e-9);
  EXPECT_LT((trace.guidance_force_N[end] - Vec3(-0.012 * 200, 0, 0)).norm(), 1e-6);
  EXPECT_EQ(trace.device_force_N[end], trace.force_N[end]);
  EXPECT_EQ(trace.intended_position_m[end], Vec3(0.02, 0.05, 0));
}

TEST(GuidedLoop, AHandThatReleasesItsGripIsLedToTheGoal) {
  const Trace trace = beside_a_goal({"operator.grip=[[1,1],[1,0]]"});
  EXPECT_GT(trace.hip_position_m[999].x(), 0.0119);
  EXPECT_LT((trace.hip_position_m[trace.length() - 1] - Vec3(0, 0.05, 0)).norm(), 1e-9);
}

// The guidance pulls from the press of the button on. The step ends when the tool is within 5 mm, and then
// the guidance stops.
TEST(GuidedLoop, ATaskIsPlayedByThePressesOfTheHand) {
  const Trace trace = beside_a_goal(
      {R"(sequence=[{"action": "activate", "fixture": "valve", "start": "button", "button": 4, "done": "reached"},
                    {"action": "release", "fixture": "valve"}])",
       "operator.presses=[[1,4,0.1]]", "operator.grip=[[1,1],[1,0]]"});
  bool left = false;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    ASSERT_EQ(trace.buttons[i], i >= 1000 && i < 1100 ? 16 : 0) << i;
    const bool there = (trace.hip_position_m[i] - Vec3(0, 0.05, 0)).norm() <= 0.005;
    left |= i >= 1000 && there;
    ASSERT_EQ(trace.guidance_active[i], i >= 1000 && !left ? 1 : 0) << i;
    ASSERT_EQ(trace.sequence_step[i], left ? 2 : 0) << i;
  }
  EXPECT_TRUE(left);
  EXPECT_LT((trace.guidance_force_N[1000] - Vec3(-4, 0, 0)).norm(), 1e-12)
      << "it jumps to its largest length";
  EXPECT_EQ(trace.force_N[trace.length() - 1], Vec3::Zero());
}

TEST(GuidedLoop, TurnsMeetWhereTheirSpringsAreEven) {
  const Trace trace = of_a_tool("[0,0,30]", {});
  const std::size_t end = trace.length() - 1;
  const double guiding = 200 * 9e-4, holding = 1;
  const Vec3 turn = rotation_vector(trace.hip_orientation[end]);
  EXPECT_LT((turn - Vec3(0, 0, 30 * kDegree * guiding / (guiding + holding))).norm(), 1e-9);
  EXPECT_EQ(trace.device_torque_Nm[end], trace.torque_Nm[end]);
}

// 7.5.2: a device without a motor for the roll cannot exert the torque that remains, so this torque never
// vanishes.
TEST(GuidedLoop, ATorqueRemainsIfTheRollHasNoMotor) {
  const Trace trace = of_a_tool("[40,0,0]", {"device.torque_x=false", "operator.grip=[[0,0]]"});
  for (std::size_t i = 0; i < trace.length(); i += 100) {
    ASSERT_LT((trace.guidance_torque_Nm[i] - Vec3(40 * kDegree * 200 * 9e-4, 0, 0)).norm(), 1e-9) << i;
    ASSERT_LT(trace.device_torque_Nm[i].norm(), 1e-15) << i;
    ASSERT_LT(rotation_vector(trace.hip_orientation[i]).norm(), 1e-9) << i;
  }
}

// The goal is turned about all axes. The hand ends where the torque is about its own roll alone.
TEST(GuidedLoop, TheTorqueThatRemainsIsAboutTheHandle) {
  const Trace trace =
      of_a_tool("[40,30,-20]", {"device.torque_x=false", "operator.grip=[[0,0]]", "duration_s=20"});
  const std::size_t end = trace.length() - 1;
  const Vec3 torque_T = trace.hip_orientation[end].conjugate() * trace.torque_Nm[end];
  EXPECT_GT(std::abs(torque_T.x()), 0.05);
  EXPECT_LT(torque_T.tail<2>().norm(), 1e-6);
  EXPECT_LT(trace.device_torque_Nm[end].norm(), 1e-6);
  // No torque remains with all motors.
  const Trace whole = of_a_tool("[40,30,-20]", {"operator.grip=[[0,0]]", "duration_s=20"});
  EXPECT_LT(whole.torque_Nm[end].norm(), 1e-6);
  EXPECT_LT(rotation_vector(whole.hip_orientation[end] * whole.guidance_orientation[end].conjugate()).norm(),
            1e-6);
}

// --- traces ---

TEST(GuidedLoop, TheTraceHasTheColumnsOfGuidanceAndHandIfTheyExist) {
  const auto has = [](const Trace& trace, const std::string& name) {
    const std::vector<Column> columns = trace.columns();
    return std::any_of(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  };
  const Trace all = beside_a_goal({}, 0.01), scripted = beside_a_goal({"operator=null"}, 0.01),
              unguided = beside_a_goal({"fixtures=[]", "guidance=null", "operator=null", "device={}"}, 0.01);
  EXPECT_TRUE(has(all, "guidance_force") && has(all, "sequence_step"));
  EXPECT_TRUE(has(all, "intended_position") && has(all, "buttons"));
  EXPECT_TRUE(has(scripted, "guidance_force") && !has(scripted, "intended_position"));
  EXPECT_TRUE(!has(unguided, "guidance_force") && has(unguided, "device_force"));
}

TEST(GuidedLoop, TheSameTaskGivesTheSameBits) {
  const std::vector<std::string> overrides{"operator.grip=[[1,1],[1,0]]", "device.torque_x=false"};
  const Trace a = beside_a_goal(overrides), b = beside_a_goal(overrides);
  ASSERT_EQ(a.hip_position_m.size(), b.hip_position_m.size());
  EXPECT_EQ(std::memcmp(a.hip_position_m.data(), b.hip_position_m.data(), 24 * a.hip_position_m.size()), 0);
  EXPECT_EQ(std::memcmp(a.device_force_N.data(), b.device_force_N.data(), 24 * a.device_force_N.size()), 0);
}

}  // namespace
}  // namespace remote_touch::guided_loop_test
