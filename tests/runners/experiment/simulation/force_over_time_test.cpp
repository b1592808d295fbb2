// When force begins, how it continues over frame updates, and when it ends: through the whole renderer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace remote_touch::force_over_time_test {
namespace {

constexpr double kContactRadius = 0.005, kStiffness = 600;
// Rest height of a proxy that is pressed straight down between four points of a grid, 1.5 mm apart: it
// touches all of them. It may rest anywhere from r1 to r2, which is 0.01 mm to both sides.
const double kRest_m = std::sqrt(kContactRadius * kContactRadius - 2 * 0.00075 * 0.00075);
constexpr double kBand_N = kStiffness * 1.03e-5;

TEST(ForceOverTime, EndsWithTheContact) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(60)));
  double time = 0;
  const auto stay = [&](const Vec3& hip) { return renderer.step({hip}, time += 0.001); };
  stay(Vec3(0, 0.02, 0));
  for (int tick = 0; tick < 20; ++tick) EXPECT_GT(stay(Vec3(0, -0.01, 0)).force_N.y(), tick > 0 ? 5 : 0);
  // The hand is far above the cloud, and then beside it. A contact that was not released would pull it back.
  for (int tick = 0; tick < 20; ++tick)
    EXPECT_TRUE(stay(Vec3(0.001 * tick, 0.04, 0)).force_N.isZero(0)) << tick;
  EXPECT_GT(stay(Vec3(0, -0.01, 0)).force_N.y(), 5);
}

// The steps of a tick end when one changes nothing, bit for bit. A free proxy is at the HIP with the first.
TEST(ForceOverTime, AFreeProxyTakesTwoStepsATick) {
  ProxyRenderer renderer = scenes::renderer();
  renderer.on_frame(scenes::frame(scenes::flat_grid(60)));
  for (int tick = 0; tick < 30; ++tick) {
    const RenderOutput out = renderer.step({Vec3(0.001 * tick, 0.02, 0)}, 0.001 * tick);
    EXPECT_LE(out.steps, 2);
    EXPECT_TRUE(out.converged);
  }
}

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

// The frames stop while v_hat is 0.1 m/s. The force may continue as if the cloud rose for max_prediction_s,
// but no longer.
TEST(ForceOverTime, IsBoundedWhenTheStreamStops) {
  const Trace trace = simulate(Experiment::load(
      "fig4.12", {"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=0",
                  "scenario.rise_s=0.6666666666666666", "scenario.acceleration_s=0", "duration_s=4"}));
  for (std::size_t i = 800; i < trace.length(); ++i)
    ASSERT_LE(trace.force_N[i].norm(), kStiffness * (0.03 + kContactRadius + 0.1 * 0.1 + 1e-3)) << i;
  EXPECT_EQ(trace.force_N[trace.length() - 1], trace.force_N[trace.length() - 1000]);
}

// Below 10 Hz a frame interval is longer than max_prediction_s: the estimate must be right all the same, and
// count until the next frame. A HIP that keeps 20 mm below the surface feels the same force all the time.
TEST(ForceOverTime, SlowStreamsHaveARightVelocityAndAnEvenForce) {
  ProxyRenderer renderer = scenes::renderer();
  RenderOutput out;
  for (int tick = 0; tick < 5000; ++tick) {
    const int frame = tick / 250;
    if (tick % 250 == 0)
      renderer.on_frame({frame, 0.25 * frame, 0.25 * frame,
                         make_search(scenes::flat_grid(40, 0.0015, 0.003 * frame - 0.02))});
    out = renderer.step({Vec3(0, tick < 2000 ? 0.005 : 0.012e-3 * tick - 0.04, 0)}, 0.001 * tick);
    if (frame <= 12) continue;
    ASSERT_NEAR(out.surface_velocity_m_per_s, 0.012, 1e-4) << tick;
    ASSERT_NEAR(out.force_N.y(), kStiffness * (0.02 + kRest_m - kContactRadius),
                kBand_N + kStiffness * 1e-4 * 0.25)
        << tick;
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

TEST(ForceOverTime, LatencyDelaysTheFrames) {
  const Trace trace = simulate(Experiment::load("fig4.11", {"frame_latency_s=0.05", "duration_s=0.1"}));
  for (std::size_t i = 0; i < trace.length(); ++i) EXPECT_EQ(trace.frame_index[i], i < 50 ? -1 : 0) << i;
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

}  // namespace
}  // namespace remote_touch::force_over_time_test
