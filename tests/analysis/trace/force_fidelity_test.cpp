// The rendered force: its stiffness in presses that follow from a formula, its difference from an expected
// force, and the energy that it gives to the hand.
#include "analysis/trace/force_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "analysis/trace/measures.h"
#include "tests/analysis/trace/example_traces.h"

namespace remote_touch::force_fidelity_test {
namespace {

using namespace example_traces;

// --- stiffness ---

const Vec3 kNormal = Vec3(0.6, 0.8, 0);

// sunk_m: depth of the contact point below the true surface. The force has a part along the surface, which no
// measure uses.
Tick press(double depth_m, double normal_N, double sunk_m = 0) {
  const bool is_force = normal_N != 0;
  return {.force_N = is_force ? Vec3(normal_N * (kNormal + Vec3(0.8, -0.6, 0.3))) : Vec3(Vec3::Zero()),
          .contact = Trace::TrueContact{-sunk_m, -depth_m},
          .normal = is_force ? kNormal : kUnknownVector};
}

using Force = std::function<double(double depth_m)>;  // N

// A motion from 2 mm above the surface to 6 mm below it, and back if there is a second force. The surface
// gives way by the force over surface_N_per_m.
std::vector<Tick> pressed(const Force& down_N, const Force& up_N = {}, double surface_N_per_m = INFINITY) {
  constexpr double kStep_m = 1e-5;
  std::vector<Tick> ticks;
  const auto add = [&](int step, const Force& force_N) {
    const double normal_N = step > 0 ? force_N(step * kStep_m) : 0;
    ticks.push_back(press(step * kStep_m, normal_N, normal_N / surface_N_per_m));
  };
  for (int i = -200; i <= 600; ++i) add(i, down_N);
  if (up_N)
    for (int i = 600; i >= -200; --i) add(i, up_N);
  return ticks;
}

Force spring(double N_per_m, double preload_N = 0) {
  return [=](double depth_m) { return N_per_m * depth_m + preload_N; };
}

TEST(Stiffness, IsThatOfTheFormula) {
  std::vector<Tick> too_high = pressed(spring(500, 0.7));
  for (Tick& tick : too_high) tick.contact->height_m = 0.7 / 500;
  const struct {
    const char* what;
    std::vector<Tick> ticks;
    double N_per_m, error, nonlinearity, tolerance = 1e-9;
  } rows[] = {
      {"a spring", pressed(spring(500), spring(500)), 500, 0, 0},
      {"a press, whatever its release", pressed(spring(500), spring(100)), 500, 0, 0},
      {"a surface that is rendered too high", too_high, 500, 0, 0},
      // The force k (x - a) that begins at the depth a has, from 0 to L, the slope k (1 - a/L)^2 (1 + 2 a/L).
      {"a force that begins too deep",
       pressed([](double depth_m) { return 500 * std::max(0.0, depth_m - 0.001); }), 500 * 25.0 / 36 * 4 / 3,
       kUnknown, kUnknown, 1},
      // Two springs in a row, 600 N/m of the coupling and 2400 N/m of the surface: 480 N/m, a fifth less.
      {"a surface that gives way", pressed(spring(480), {}, 2400), 480, -0.2, 0},
      // The line of least squares of x^2 from 0 to a is a x - a^2 / 6; the rest has the rms a^2 / sqrt(180).
      // For equally spaced x from a to b its slope is a + b.
      {"a square", pressed([](double depth_m) { return 1e5 * depth_m * depth_m; }), 1e5 * (0.00002 + 0.006),
       kUnknown, 1 / std::sqrt(180), 1e-3}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.what);
    const Trace trace = run_of(row.ticks);
    std::vector<std::pair<const char*, double>> expected = {{"rendered_stiffness", row.N_per_m}};
    if (!std::isnan(row.error)) expected.emplace_back("stiffness_error", row.error);
    if (!std::isnan(row.nonlinearity)) expected.emplace_back("stiffness_nonlinearity", row.nonlinearity);
    expect_values(trace, expected, row.tolerance);
  }
}

TEST(Hysteresis, IsTheLostPartOfTheWork) {
  const auto of = [](const Force& up_N) {
    return value("stiffness_hysteresis", run_of(pressed(spring(500), up_N)));
  };
  EXPECT_NEAR(of(spring(500)), 0, 1e-12);
  EXPECT_NEAR(of(spring(400)), 0.2, 1e-9);
  EXPECT_NEAR(of(spring(550)), -0.1, 1e-9);
  EXPECT_NEAR(of(spring(0)), 1, 1e-9);
  // The square encloses a^3 / 3 of a^3 / 2.
  EXPECT_NEAR(of([](double depth_m) { return 500 / 0.006 * depth_m * depth_m; }), 1.0 / 3, 1e-3);
}

// Two presses to 6 mm and a release to 3 mm only: the work is compared between 3 and 6 mm.
TEST(Hysteresis, UsesTheIndentationsThatBothHave) {
  std::vector<Tick> ticks = pressed(spring(500));
  const std::vector<Tick> again = ticks;
  for (int i = 600; i >= 300; --i) ticks.push_back(press(i * 1e-5, 0.9 * 500 * i * 1e-5));
  EXPECT_NEAR(stiffness_hysteresis(run_of(ticks)), 0.1, 1e-3);
  ticks.insert(ticks.end(), again.begin(), again.end());
  EXPECT_NEAR(stiffness_hysteresis(run_of(ticks)), 0.1, 1e-3);
}

TEST(Stiffness, IsNanWithoutAPress) {
  std::vector<Tick> shallow, slow, unknown = pressed(spring(500), spring(500));
  for (int i = 0; i < 99; ++i) shallow.push_back(press(1e-5 * i, 0.1 * i));
  for (int i = 0; i < 99999; ++i) slow.push_back(press(0.9 * kPressing_m_per_s * 0.001 * i, 0.01 * i));
  for (Tick& tick : unknown) tick.normal = kUnknownVector;
  const std::vector<Tick> at_rest(900, press(0.003, 2)), no_force = pressed(spring(0), spring(0)),
                                                         pulls_in = pressed(spring(0, -2), spring(0, -2)),
                                                         not_computed(3);
  for (const auto& ticks :
       {std::vector<Tick>(), shallow, slow, unknown, at_rest, no_force, pulls_in, not_computed}) {
    const Trace trace = run_of(ticks);
    for (const auto measure :
         {rendered_stiffness_N_per_m, stiffness_error, stiffness_nonlinearity, stiffness_hysteresis})
      EXPECT_TRUE(std::isnan(measure(trace))) << ticks.size() << " ticks";
  }
}

// --- the expected force ---

// Errors of 3, 4 and 0 N; expected forces of 5, 0 and 0 N.
TEST(ReplayMeasures, ErrorIsTheRmsOverAllTicks) {
  const Vec3 none = Vec3::Zero();
  expect_values(run_of({{.force_N = {0, 4, 0}, .expected_N = Vec3(3, 4, 0)},
                        {.force_N = {0, 0, 4}, .expected_N = none},
                        {.expected_N = none}}),
                {{"rms_force_error", std::sqrt(25.0 / 3)}, {"relative_force_error", 1}});
  for (const Vec3& force_N : {none, Vec3(0, 1, 0)})
    expect_no_values(run_of({{.force_N = force_N, .expected_N = none}}), {"relative_force_error"});
}

TEST(ReplayMeasures, AScaledForceHasTheScaleAsItsRelativeError) {
  std::vector<Tick> ticks;
  double squares = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 expected(0.01 * i, 1 + 0.02 * i, -0.03 * i);
    ticks.push_back({.force_N = 0.75 * expected, .expected_N = expected});
    squares += expected.squaredNorm();
  }
  expect_values(run_of(ticks),
                {{"relative_force_error", 0.25},
                 {"rms_force_error", 0.25 * std::sqrt(squares / 100)},
                 {"force_direction_error", 0}},
                1e-14);
}

// Only ticks with both forces have an angle: 90 degrees, 45 degrees and 0.
TEST(ReplayMeasures, DirectionErrorIsTheMeanAngleWhereBothAreFelt) {
  const Vec3 up(0, 2, 0);
  std::vector<Tick> ticks = {{.force_N = {7, 0, 0}, .expected_N = Vec3(0, 0, 0)}};
  for (const Vec3& force_N :
       {Vec3(1, 0, 0), Vec3(0, 3, 3), Vec3(0, 5, 0), Vec3(0, 0, 0), Vec3(0.9 * kContactForce_N, 0, 0)})
    ticks.push_back({.force_N = force_N, .expected_N = up});
  expect_values(run_of(ticks), {{"force_direction_error", (M_PI / 2 + M_PI / 4) / 3}});
}

// Four ticks without an expected force, one of them with a force; three with one, two of them without force.
TEST(ReplayMeasures, CountFalseAndLostContacts) {
  const Vec3 none = Vec3::Zero(), force(0, 1, 0), little(0, 0.9 * kContactForce_N, 0),
             small(0, 0.9 * kExpectedContact_N, 0);
  std::vector<Tick> ticks;
  for (const Vec3& force_N : {none, force, little, none})
    ticks.push_back({.force_N = force_N, .expected_N = none});
  for (const Vec3& force_N : {none, little, force})
    ticks.push_back({.force_N = force_N, .expected_N = force});
  ticks.push_back({.expected_N = small});
  expect_values(run_of(ticks), {{"false_contact_fraction", 0.25}, {"lost_contact_fraction", 2.0 / 3}});
}

TEST(ReplayMeasures, DoNotUseTicksWithoutAnExpectedForceNorGuidance) {
  const Tick unknown{.force_N = {9, 9, 9}, .expected_N = kUnknownVector},
      known{.force_N = {0, 2.5, 0}, .expected_N = Vec3(0, 2, 0)},
      infinite{.force_N = kUnknownVector, .expected_N = Vec3(0, 2, 0)};
  expect_values(run_of({unknown, known}), {{"rms_force_error", 0.5},
                                           {"relative_force_error", 0.25},
                                           {"lost_contact_fraction", 0},
                                           {"false_contact_fraction", kUnknown}});
  expect_values(
      run_of({known, infinite}),
      {{"rms_force_error", kUnknown}, {"relative_force_error", kUnknown}, {"lost_contact_fraction", 0.5}});
  const Trace guided =
      run_of({{.force_N = {4, 2, 0}, .guidance_N = Vec3(4, 0, 0), .expected_N = Vec3(0, 2, 0)}});
  expect_values(guided, {{"rms_force_error", 0}, {"force_direction_error", 0}});
}

// --- energy ---

Trace moved(const std::vector<std::pair<double, double>>& force_N_and_hip_m,
            const std::vector<int>& frames = {}) {
  std::vector<Tick> ticks;
  for (const auto& [force_N, hip_m] : force_N_and_hip_m)
    ticks.push_back({.force_N = {0, force_N, 0},
                     .frame = ticks.size() < frames.size() ? frames[ticks.size()] : 0,
                     .hip_m = {0, hip_m, 0}});
  return run_of(ticks);
}

TEST(PassivityMeasures, ASpringGivesBackWhatItTookAndNoMore) {
  constexpr int kStiffer = 528;  // first tick with 1.5 times the stiffness, on the way out
  std::vector<std::pair<double, double>> ticks;
  double before = 0, after = 0;  // sums of squared steps
  for (int i = 0; i <= 1000; ++i) {
    const double depth = 0.01 * std::sin(M_PI * i / 1000);
    if (i > 0) (i <= kStiffer ? before : after) += std::pow(depth + ticks.back().second, 2);
    ticks.emplace_back(600 * depth, -depth);
  }
  // Sampling injects energy: each force is held while the hand moves on, k / 2 (sum of steps^2) in all.
  expect_values(moved(ticks), {{"max_energy_injected", 300 * (before + after)}}, 1e-14);
  for (int i = kStiffer; i <= 1000; ++i) ticks[static_cast<std::size_t>(i)].first *= 1.5;
  const double more = 150 * std::pow(ticks[kStiffer].second, 2);  // half of the added 300 N/m
  expect_values(moved(ticks), {{"max_energy_injected", more + 300 * before + 450 * after}}, 1e-14);
}

// A spring that is pressed and released gives back what it took. One that gets stiffer in between gives more.
TEST(PassivityMeasures, EnergyIsForceTimesDisplacementOfTheHand) {
  EXPECT_NEAR(energy_injected_J(moved({{2, 0}, {2, -0.01}, {2, 0}})), 0, 1e-17);
  EXPECT_NEAR(value("energy_injected", moved({{2, 0}, {5, -0.01}, {100, 0}})), 0.01 * (5 - 2), 1e-17);
  EXPECT_LT(energy_injected_J(moved({{2, 0}, {2, -0.01}})), 0);
  EXPECT_EQ(energy_injected_J(moved({{2, 0}})), 0);
  EXPECT_EQ(energy_injected_J(Trace()), 0);
  // The maximum over time: 2 J to the hand, then 5 J from it.
  EXPECT_EQ(max_energy_injected_J(moved({{1, 0}, {1, 2}, {1, -3}})), 2);
  EXPECT_EQ(max_energy_injected_J(moved({{1, 0}, {1, -1}, {1, -3}})), 0);
  EXPECT_EQ(max_energy_injected_J(Trace()), 0);
}

// A torque of 0.5 N m turns the hand by 0.2 rad about an axis at 60 degrees to it, and 2 N push it by 1 cm.
// Work is done by the force that the device exerts, not by the renderer's command: here a motor is missing.
TEST(PassivityMeasures, WorkIncludesTheTorqueAndIsThatOfTheMotors) {
  const Vec3 axis_W(0.5, std::sqrt(0.75), 0), torque_Nm(0.5, 0, 0);
  const Eigen::Quaterniond start = rotation({0.3, -0.1, 0.7});
  const Trace turned = run_of(
      {{.force_N = {0, 2, 0}, .hip_orientation = start, .torque_Nm = torque_Nm},
       {.hip_m = {0, 0.01, 0}, .hip_orientation = rotation(0.2 * axis_W) * start, .torque_Nm = torque_Nm}});
  EXPECT_NEAR(energy_injected_J(turned), 2 * 0.01 + 0.5 * 0.2 * 0.5, 1e-15);
  const Vec3 motors_N(0, 2, 0);
  const Trace hand = run_of(
      {{.force_N = {3, 2, 0}, .device_N = motors_N}, {.hip_m = {0.01, 0.01, 0}, .device_N = motors_N}});
  EXPECT_NEAR(energy_injected_J(hand), 0.02, 1e-17);
  EXPECT_NEAR(max_energy_injected_J(hand), 0.02, 1e-17);
}

// Frame updates are at the ticks 1, 3, 5 and 7. The work between them is 3, -2 and, without force, 0 J.
TEST(PassivityMeasures, EnergyPerUpdateIsOfWholePiecesWithForce) {
  expect_values(moved({{9, 0}, {1, 0}, {1, 1}, {-1, 3}, {-1, 4}, {0, 5}, {0, 9}, {7, 12}, {7, 20}},
                      {0, 1, 1, 2, 2, 3, 3, 4, 4}),
                {{"mean_energy_per_update", 0.5}, {"max_energy_per_update", 3}});
  expect_no_values(moved({{9, 0}, {9, 1}}, {0, 1}), {"mean_energy_per_update"});
  expect_no_values(moved({}), {"max_energy_per_update"});
}

// Frame updates are at the ticks 1, 3 and 5. In the first run the renderer always commands a force, but the
// device exerts one only between the second update and the third. In the second run the hand turns by 0.1 rad
// in each tick, and the tool exerts a torque of 0.5 N m only between the first two updates, and never a
// force.
TEST(PassivityMeasures, APieceCountsIfTheHandFeelsAForceOrATorque) {
  std::vector<Tick> motors, torque;
  for (int i = 0; i < 7; ++i) {
    motors.push_back({.force_N = {3, 0, 0},
                      .frame = (i + 1) / 2,
                      .hip_m = {0.01 * i, 0.01 * i, 0},
                      .device_N = Vec3(0, i == 3 || i == 4 ? 2.0 : 0.0, 0)});
    torque.push_back({.frame = (i + 1) / 2,
                      .hip_m = {0.01 * i, 0, 0},
                      .hip_orientation = rotation({0, 0.1 * i, 0}),
                      .torque_Nm = Vec3(0, i == 1 || i == 2 ? 0.5 : 0, 0)});
  }
  expect_values(run_of(motors), {{"mean_energy_per_update", 2 * 2 * 0.01}});
  expect_values(run_of(torque),
                {{"mean_energy_per_update", 2 * 0.5 * 0.1}, {"max_energy_per_update", 2 * 0.5 * 0.1}});
}

}  // namespace
}  // namespace remote_touch::force_fidelity_test
