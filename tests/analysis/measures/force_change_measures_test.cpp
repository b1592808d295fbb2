#include "analysis/measures/force_change_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/trace/trace.h"

namespace remote_touch::force_change_measures_test {
namespace {

struct Tick {
  Vec3 force_N = Vec3::Zero();
  int frame = 0;
};

Trace trace_of(const std::vector<Tick>& ticks, bool tool = false) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.frame_index = tick.frame;
    out.force_N = tool ? Vec3(1, 1, 1) : tick.force_N;
    if (tool) out.tool.emplace().torque_Nm = tick.force_N;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

Tick pushed(double force_y_N, int frame) {
  return {{0, force_y_N, 0}, frame};
}

// The force changes at frame updates from 0 to 5, 6 to 9, 8 to 4, 0 to 0 and 0 to 7 N, and between them by 1,
// 1, 2 and 2 N.
const std::vector<Tick> kTicks = {pushed(0, 0), pushed(5, 1), pushed(6, 1), pushed(9, 2), pushed(8, 2),
                                  pushed(4, 3), pushed(2, 3), pushed(0, 3), pushed(0, 4), pushed(7, 5)};

TEST(ForceChange, IsMeasuredAtUpdatesAndBetweenThem) {
  const Trace trace = trace_of(kTicks);
  EXPECT_EQ(max_force_jump_N(trace), 7);
  EXPECT_NEAR(rms_force_jump_N(trace), std::sqrt((25.0 + 9 + 16 + 49) / 4), 1e-15);
  EXPECT_NEAR(force_noise_N(trace), std::sqrt((1.0 + 1 + 4 + 4) / 4), 1e-15);
}

TEST(ForceChange, AForceThatIsLostAtAnUpdateIsAJump) {
  EXPECT_EQ(max_force_jump_N(trace_of({pushed(3, 0), pushed(8, 0), pushed(0, 1), pushed(0, 2)})), 8);
  EXPECT_EQ(rms_force_jump_N(trace_of({pushed(3, 0), pushed(8, 0), pushed(0, 1), pushed(0, 2)})), 8);
}

TEST(ForceChange, IsTheLengthOfTheDifferenceWhenTheForceTurns) {
  EXPECT_EQ(force_noise_N(trace_of({{{3, 0, 0}, 0}, {{0, 0, 4}, 0}})), 5);
  EXPECT_EQ(max_force_jump_N(trace_of({{{3, 0, 0}, 0}, {{0, 0, 4}, 1}})), 5);
}

TEST(ForceChange, IsNanIfNoChangeCounts) {
  for (const auto& ticks : {std::vector<Tick>{}, {pushed(1, 0)}, {pushed(0, 0), pushed(0, 1), pushed(0, 1)}})
    for (const auto measure : {max_force_jump_N, rms_force_jump_N, force_noise_N})
      EXPECT_TRUE(std::isnan(measure(trace_of(ticks)))) << ticks.size();
  EXPECT_TRUE(std::isnan(max_force_jump_N(trace_of({pushed(1, 0), pushed(2, 0)}))));
  EXPECT_TRUE(std::isnan(force_noise_N(trace_of({pushed(1, 0), pushed(2, 1)}))));
}

TEST(ForceChange, TheTorqueOfAToolIsMeasuredLikeTheForce) {
  const Trace trace = trace_of(kTicks, true);
  EXPECT_EQ(max_torque_jump_Nm(trace), 7);
  EXPECT_NEAR(rms_torque_jump_Nm(trace), std::sqrt((25.0 + 9 + 16 + 49) / 4), 1e-15);
  EXPECT_NEAR(torque_noise_Nm(trace), std::sqrt((1.0 + 1 + 4 + 4) / 4), 1e-15);
  for (const auto measure : {max_torque_jump_Nm, rms_torque_jump_Nm, torque_noise_Nm})
    EXPECT_TRUE(std::isnan(measure(trace_of(kTicks))));
}

// --- how a force settles ---

// A force of this size, over time, from the tick at 0.2 s on. The first frame comes then.
template <class Size>
Trace step_response(Size&& size_N, double until_s = 1) {
  std::vector<Tick> ticks;
  for (int i = 0; 0.001 * i < until_s; ++i)
    ticks.push_back(pushed(i < 200 ? 0 : size_N(0.001 * (i - 200)), 0));
  return trace_of(ticks);
}

// A damped oscillation about 4 N, from 0 at its start. With the damping ratio zeta, its first overshoot is
// exp(-pi zeta / sqrt(1 - zeta^2)) of the final value, after half a period.
TEST(ForceChange, OvershootAndSettlingTimeAreThoseOfADampedOscillator) {
  constexpr double kPi = 3.14159265358979323846, kFrequency = 60;  // rad/s, undamped
  for (const double zeta : {0.2, 0.3, 0.5}) {
    const double damped = std::sqrt(1 - zeta * zeta);
    const auto part_at = [&](double t) {  // part of the final value that is missing
      return std::exp(-zeta * kFrequency * t) *
             (std::cos(damped * kFrequency * t) + zeta / damped * std::sin(damped * kFrequency * t));
    };
    const Trace trace = step_response([&](double t) { return 4 * (1 - part_at(t + 0.001)); });
    EXPECT_NEAR(force_overshoot(trace), std::exp(-kPi * zeta / damped), 0.002) << zeta;
    int last_outside = 0;
    for (int i = 0; i < 700; ++i)
      if (std::abs(part_at(0.001 * i)) > kSettledBand) last_outside = i;
    EXPECT_NEAR(force_settling_time_s(trace), 0.001 * last_outside, 0.0011) << zeta;
  }
}

TEST(ForceChange, AForceThatIsThereAtOnceHasNoOvershoot) {
  const Trace constant = step_response([](double) { return 3.0; });
  EXPECT_EQ(force_overshoot(constant), 0);
  EXPECT_EQ(force_settling_time_s(constant), 0);
  const Trace rises = step_response([](double t) { return 3 * std::min(1.0, t / 0.3 + 0.001); });
  EXPECT_EQ(force_overshoot(rises), 0);
  EXPECT_NEAR(force_settling_time_s(rises), 0.95 * 0.3, 0.002);
}

// The mean of equal forces is rounded up or down.
TEST(ForceChange, NoForceThatStaysHasAnOvershoot) {
  for (int i = 1; i < 200; ++i)
    EXPECT_EQ(force_overshoot(step_response([&](double) { return 0.07 * i; }, 0.4)), 0) << i;
}

TEST(ForceChange, ARunThatIsNotSteadyAtItsEndDoesNotSettle) {
  const std::vector<Trace> unsteady = {
      step_response([](double t) { return 1 + 10 * t; }),
      step_response([](double) { return 0.0; }),
      step_response([](double t) { return t < 0.75 ? 3.0 : 0.0; }),
      step_response([](double) { return 3.0; }, 0.25),
      step_response([](double t) { return t > 0.3 && t < 0.302 ? std::nan("") : 3.0; }),
      Trace()};
  for (std::size_t i = 0; i < unsteady.size(); ++i) {
    EXPECT_TRUE(std::isnan(force_overshoot(unsteady[i]))) << i;
    EXPECT_TRUE(std::isnan(force_settling_time_s(unsteady[i]))) << i;
  }
}

TEST(ForceChange, GuidanceIsNoPartOfIt) {
  Trace trace = trace_of(kTicks);
  const double jump_N = max_force_jump_N(trace), noise_N = force_noise_N(trace);
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 pull_N(std::pow(2.0, static_cast<double>(i % 5)), 8, -4);
    trace.force_N[i] += pull_N;
    trace.guidance_force_N.push_back(pull_N);
    trace.guidance_goal_m.push_back(Vec3::Zero());
  }
  EXPECT_EQ(max_force_jump_N(trace), jump_N);
  EXPECT_EQ(force_noise_N(trace), noise_N);
}

}  // namespace
}  // namespace remote_touch::force_change_measures_test
