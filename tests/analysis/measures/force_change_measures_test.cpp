#include "analysis/measures/force_change_measures.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace remote_touch::force_change_measures_test
