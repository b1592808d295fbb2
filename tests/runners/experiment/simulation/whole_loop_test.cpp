// The force through the whole loop: how it continues over frame updates, with regions that are switched, and
// with guidance, a hand that feels it and a device that lacks a motor, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/analysis/trace/measure_named.h"
#include "tests/support/scenes.h"

namespace remote_touch::whole_loop_test {
namespace {

constexpr double kContactRadius = 0.005, kStiffness = 600;
// Rest height of a proxy that is pressed straight down between four points of a grid, 1.5 mm apart: it
// touches all of them. It may rest anywhere from r1 to r2, which is 0.01 mm to both sides.
const double kRest_m = std::sqrt(kContactRadius * kContactRadius - 2 * 0.00075 * 0.00075);
constexpr double kBand_N = kStiffness * 1.03e-5;

// A cloud that rises evenly. A tick has one step, so the tick of an update ends before the proxy is in
// contact again.
TEST(ForceOverTime, TheLatestContactIsCarriedWithTheCloud) {
  ProxyParameters parameters;
  parameters.steps_per_tick = 1;
  ProxyRenderer renderer = scenes::renderer(parameters);
  double before = 0, max_jump = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double time = 0.001 * tick;
    const int frame = tick / 40;
    // 25 frames a second at 0.1 m/s. The cloud accelerates by 1 m/s^2 from frame 12 on.
    const auto height = [](int j) {
      const double s = std::max(0, j - 12) / 25.0;
      return 0.004 * j - 0.03 + 0.5 * s * s;
    };
    if (tick % 40 == 0)
      renderer.on_frame(
          {frame, frame / 25.0, frame / 25.0, make_search(scenes::flat_grid(40, 0.0015, height(frame)))});
    const double fraction = (tick % 40) / 40.0;
    const double surface = height(frame) + fraction * (height(frame + 1) - height(frame));
    const RenderOutput out = renderer.step({Vec3(0, frame < 8 ? 0 : surface - 0.02, 0)}, time);
    if (tick % 40 == 0 && frame > 13) max_jump = std::max(max_jump, std::abs(out.force_N.y() - before));
    before = out.force_N.y();
  }
  // The estimate cannot know the acceleration: a / f_c^2 = 1.6 mm, 0.96 N. A contact that was left behind
  // would jump by the whole update, more than 4 mm.
  EXPECT_LT(max_jump, 1.2);
  EXPECT_GT(before, 5);
}

// t_j of (4.15) is when the cloud was updated, not when the camera saw it: in the tick of an arrival the
// velocity term is zero, and the force is the spring's alone, of a HIP 20 mm below the surface.
TEST(ForceOverTime, CountsFromTheArrivalOfTheFrame) {
  ProxyRenderer renderer = scenes::renderer();
  RenderOutput out;
  for (int tick = 0; tick < 400; ++tick) {
    const int frame = tick / 40 - 1;  // arrives 40 ms after its capture
    if (tick % 40 == 0 && frame >= 0)
      renderer.on_frame({frame, frame / 25.0, 0.001 * tick,
                         make_search(scenes::flat_grid(40, 0.0015, 0.004 * frame - 0.02))});
    const Vec3 hip(0, tick < 200 ? 0.006 : 0.004 * frame - 0.04, 0);
    out = renderer.step({hip}, 0.001 * tick);
    if (tick % 40 != 0 || frame < 6) continue;
    ASSERT_NEAR(out.surface_velocity_m_per_s, 0.1, 1e-6);
    EXPECT_NEAR(out.force_N.y(), kStiffness * (0.02 + kRest_m - kContactRadius), kBand_N) << tick;
  }
}

// A rule of 900 N/m fades in over 1.5 s, in 45 frames, over a renderer of 300 N/m. The force on a HIP at rest
// rises in steps as even as those of the schedule.
TEST(ForceOverTime, AStiffnessFadesInLinearly) {
  for (const char* renderer : {"proxy", "penalty", "implicit-surface", "surfels", "god-object"}) {
    const std::string of = renderer;
    const Trace trace = simulate(Experiment::from_json(
        R"({"scenario": {"name": "flat-grid"}, "duration_s": 2, "renderer": {"name": ")" + of +
            R"(", "stiffness_N_per_m": 300}, "trajectory": {"name": "waypoints",
             "waypoints": [[0, 0.02, 0, 0], [0, )" +
            (of == "penalty" ? "0.002" : "-0.01") + R"(, 0, 0.2]]}, "fixtures": [{"name": "everywhere",
             "radius_m": 0, "stiffness_N_per_m": 900, "schedule": [[0.3, 0], [1.8, 1]]}]})",
        "test"));
    const double soft_N = trace.force_N[299].norm(), stiff_N = trace.force_N[trace.length() - 1].norm();
    EXPECT_NEAR(stiff_N, 3 * soft_N, 1e-3) << of;
    for (std::size_t i = 300; i < trace.length(); ++i)
      ASSERT_LT(trace.force_N[i].norm() - trace.force_N[i - 1].norm(), 1.1 * (stiff_N - soft_N) / 45)
          << of << " at tick " << i;
  }
}

// --- a scene that stops, and a scene at rest, for every renderer of a point ---

constexpr double kPressed_m = 0.005;

// The hand waits, and the scene comes to it or it goes to the scene. frame_drop_probability: 1e-300 makes the
// camera repeat the only frame of a scene at rest, and loses none.
Trace pressed(const std::string& renderer, const nlohmann::ordered_json& scenario,
              double frame_drop_probability = 0) {
  return simulate(Experiment::from_json(nlohmann::ordered_json{
      {"scenario", scenario},
      {"renderer", {{"name", renderer}}},
      {"trajectory", {{"name", "waypoints"}, {"waypoints", {{0, 0.01, 0, 0}, {0, -kPressed_m, 0, 0.1}}}}},
      {"frame_drop_probability", frame_drop_probability},
      {"duration_s", 1.2}}));
}

const nlohmann::ordered_json kAtRest = {{"name", "moving-shape"}, {"columns", 40}, {"rows", 40}};

// The surface rises by 10 mm and stops at 0.5 s, 5 mm above the hand. Without frames after the stop, the
// velocity of the rise would stay in the estimate and in the force.
TEST(ForceOverTime, AfterTheSceneStopsItIsThatOfASceneAtRest) {
  nlohmann::ordered_json rises = kAtRest;
  rises.update({{"start_depth_m", 0.01}, {"start_velocity_m_per_s", 0.02}, {"rise_s", 0.5}});
  int held = 0;
  for (const RendererEntry& entry : renderers()) {
    if (entry.degrees_of_freedom != DegreesOfFreedom::three) continue;
    const Trace moved = pressed(entry.name, rises), rested = pressed(entry.name, kAtRest);
    EXPECT_LT(std::abs(moved.surface_velocity_m_per_s.back()), 1e-4) << entry.name;
    if (moved.signed_distance_m.back() < -0.001 || rested.signed_distance_m.back() < -0.001) continue;
    ++held;
    EXPECT_NEAR(moved.force_N.back().y(), rested.force_N.back().y(), 0.05) << entry.name;
  }
  EXPECT_GE(held, 6) << "these renderers do not lose a surface that rises slowly";
}

// So the camera need not repeat the only frame of a scene.
TEST(ForceOverTime, ARepetitionOfTheOnlyFrameChangesNoForce) {
  for (const RendererEntry& entry : renderers()) {
    if (entry.degrees_of_freedom != DegreesOfFreedom::three) continue;
    const Trace once = pressed(entry.name, kAtRest), again = pressed(entry.name, kAtRest, 1e-300);
    ASSERT_GT(again.frame_index.back(), 30) << entry.name;
    ASSERT_EQ(once.frame_index.back(), 0) << entry.name;
    double most_N = 0;
    for (std::size_t i = 0; i < once.length(); ++i)
      most_N = std::max(most_N, (once.force_N[i] - again.force_N[i]).norm());
    EXPECT_LT(most_N, 1e-6) << entry.name;
  }
}

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

TEST(GuidedLoop, TurnsMeetWhereTheirSpringsAreEven) {
  const Trace trace = of_a_tool("[0,0,30]", {});
  const std::size_t end = trace.length() - 1;
  const double guiding = 200 * 9e-4, holding = 1;
  const Vec3 turn = rotation_vector(trace.hip_orientation[end]);
  EXPECT_LT((turn - Vec3(0, 0, 30 * kDegree * guiding / (guiding + holding))).norm(), 1e-9);
  EXPECT_EQ(trace.device_torque_Nm[end], trace.torque_Nm[end]);
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

}  // namespace
}  // namespace remote_touch::whole_loop_test
