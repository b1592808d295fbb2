#include "core/rendering/surface_velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace remote_touch::surface_velocity_test {
namespace {

const Vec3 kUp = Vec3::UnitY();
constexpr double kInterval = 1.0 / 32;  // exact in binary, so that sums of it are too

TEST(SurfaceVelocity, FirstFrameNeitherMovesTheProxyNorChangesTheEstimate) {
  SurfaceVelocity velocity(1);
  EXPECT_EQ(velocity.on_frame(7, kUp), Vec3(0, 0, 0));
  velocity.on_step(0.003 * kUp);
  EXPECT_EQ(velocity.m_per_s(), 0);
  EXPECT_EQ(velocity.on_frame(7 + kInterval, kUp), Vec3(0, 0, 0));
}

// A step before any frame has no interval to be divided by.
TEST(SurfaceVelocity, StepsBeforeTheFirstFrameAreIgnored) {
  SurfaceVelocity velocity(1);
  velocity.on_step(kUp);
  EXPECT_EQ(velocity.m_per_s(), 0);
  EXPECT_EQ(velocity.vector(), Vec3(0, 0, 0));
}

TEST(SurfaceVelocity, EvenMotionIsKnownAfterOneUpdate) {
  const double v = 0.1;
  SurfaceVelocity velocity(1);
  double surface = 0, proxy = 0;
  for (int frame = 0; frame < 6; ++frame) {
    surface = frame * v * kInterval;
    proxy += velocity.on_frame(frame * kInterval, kUp).y();
    const double step = surface - proxy;  // distance back to the surface
    if (frame == 1) {
      EXPECT_NEAR(step, v * kInterval, 1e-17);
    }
    if (frame >= 2) {
      EXPECT_NEAR(step, 0, 1e-16) << frame;
    }
    velocity.on_step({0.5, step, -0.25});  // the tangential part gives no information
    proxy = surface;
    EXPECT_NEAR(velocity.m_per_s(), frame == 0 ? 0 : v, 1e-15) << frame;
  }
}

// The estimate lags one frame under acceleration a: the correction misses a / f_c^2, the bound of (4.14).
TEST(SurfaceVelocity, AccelerationIsMissedByOneFrame) {
  const double a = 3;
  SurfaceVelocity velocity(1);
  double surface = 0, speed = 0, proxy = 0;
  for (int frame = 0; frame < 10; ++frame) {
    if (frame > 0) speed += a * kInterval, surface += speed * kInterval;
    proxy += velocity.on_frame(frame * kInterval, kUp).y();
    if (frame > 0) {
      EXPECT_NEAR(surface - proxy, a * kInterval * kInterval, 1e-15) << frame;
    }
    velocity.on_step((surface - proxy) * kUp);
    proxy = surface;
    EXPECT_NEAR(velocity.m_per_s(), speed, 1e-14) << frame;
  }
}

TEST(SurfaceVelocity, NormalOfTheFrameIsUsedUntilTheNext) {
  const Vec3 tilted = Vec3(1, 2, 2) / 3;
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, tilted);
  velocity.on_step({0.003, 0.006, 0.006});  // 0.009 along the normal
  EXPECT_NEAR(velocity.m_per_s(), 0.009 / kInterval, 1e-15);
  EXPECT_LT((velocity.vector() - 0.009 / kInterval * tilted).norm(), 1e-15);
  const Vec3 correction = velocity.on_frame(2 * kInterval, kUp);
  EXPECT_LT((correction - 0.009 * kUp).norm(), 1e-16) << "(4.3) is along the newest normal";
}

TEST(SurfaceVelocity, OnlyTheFirstStepAfterAFrameCounts) {
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(0.001 * kUp);
  const double first = velocity.m_per_s();
  EXPECT_NEAR(first, 0.001 / kInterval, 1e-16);
  velocity.on_step(0.002 * kUp);
  velocity.on_step(-0.5 * kUp);
  EXPECT_EQ(velocity.m_per_s(), first);
  velocity.on_frame(2 * kInterval, kUp);
  velocity.on_step(0.002 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.003 / kInterval, 1e-15);
}

TEST(SurfaceVelocity, IsNeverNegativeAndNeverReset) {
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(-0.004 * kUp);
  EXPECT_EQ(velocity.m_per_s(), 0);
  velocity.on_frame(2 * kInterval, kUp);
  velocity.on_step(0.004 * kUp);
  const double v = velocity.m_per_s();
  EXPECT_NEAR(v, 0.004 / kInterval, 1e-16) << "a clamped estimate owes nothing";
  velocity.on_frame(3 * kInterval, kUp);
  velocity.on_step(Vec3::Zero());
  EXPECT_EQ(velocity.m_per_s(), v) << "a zero step confirms the estimate";
  velocity.on_frame(4 * kInterval, kUp);
  velocity.on_step(-0.001 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.003 / kInterval, 1e-15);
}

TEST(SurfaceVelocity, IntervalIsBetweenTheCaptures) {
  SurfaceVelocity velocity(1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(0.002 * kUp);
  // One frame is lost: twice the time, twice the way.
  EXPECT_NEAR(velocity.on_frame(3 * kInterval, kUp).y(), 0.004, 1e-17);
  velocity.on_step(0.002 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.002 / kInterval + 0.002 / (2 * kInterval), 1e-15);
}

TEST(SurfaceVelocity, PredictionIsBoundedWhenFramesStayAway) {
  const double max_length = 0.1;
  SurfaceVelocity velocity(max_length);
  velocity.on_frame(0, kUp);
  velocity.on_frame(kInterval, kUp);
  velocity.on_step(0.005 * kUp);
  const double v = velocity.m_per_s();
  EXPECT_NEAR(velocity.on_frame(kInterval + 60, kUp).y(), v * max_length, 1e-16);
  velocity.on_step(0.001 * kUp);
  // The velocity is the carried distance plus the step, over the true time.
  EXPECT_NEAR(velocity.m_per_s(), (v * max_length + 0.001) / 60, 1e-15);
  EXPECT_NEAR(velocity.on_frame(2 * kInterval + 60, kUp).y(), velocity.m_per_s() * kInterval, 1e-15);
}

// The next frame of a slow stream comes later than max_interval_s, and until then v_hat is all that is known.
TEST(SurfaceVelocity, IsTrustedForAFrameIntervalOfASlowStream) {
  SurfaceVelocity estimated(0.1), measured(0.1);
  double time_s = 3;
  const auto horizon_after = [&](double interval_s) {
    time_s += interval_s;
    estimated.on_frame(time_s, kUp), estimated.on_step(Vec3::Zero());
    measured.on_measured(time_s, 0.2, kUp);
    EXPECT_EQ(measured.horizon_s(), estimated.horizon_s());
    return estimated.horizon_s();
  };
  EXPECT_EQ(estimated.horizon_s(), 0.1);
  EXPECT_EQ(horizon_after(0), 0.1) << "the first frame has no interval";
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(horizon_after(0.25), 0.25);
  for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(horizon_after(kInterval), 0.1);
}

// Returns the horizon after a first frame and frames at these intervals. The estimated and the measured
// velocity must agree on it.
double horizon_after(std::initializer_list<double> intervals_s) {
  SurfaceVelocity estimated(0.1), measured(0.1);
  double time_s = 3;
  const auto add_frame = [&] {
    estimated.on_frame(time_s, kUp), estimated.on_step(0.001 * kUp);
    measured.on_measured(time_s, 0.2, kUp);
  };
  add_frame();
  for (const double interval_s : intervals_s) time_s += interval_s, add_frame();
  EXPECT_EQ(measured.horizon_s(), estimated.horizon_s());
  return estimated.horizon_s();
}

// If the stream stops again right after a pause of a minute, (4.15) must not grow for another minute.
TEST(SurfaceVelocity, APauseOfTheStreamIsNoInterval) {
  EXPECT_EQ(horizon_after({kInterval, kInterval, 60}), 0.1);
  EXPECT_EQ(horizon_after({0.25, 0.25, 60}), 0.75) << "three of its intervals";
  EXPECT_EQ(horizon_after({0.25, 0.25, 60, 0.25}), 0.25);
  EXPECT_EQ(horizon_after({0.25, 60, 0, 60}), 2.25)
      << "frames without an interval say nothing about the rate";
}

TEST(SurfaceVelocity, LostFramesAndASlowerStreamAreIntervals) {
  for (const double lost : {0.25, 0.5, 0.75}) EXPECT_EQ(horizon_after({0.25, lost}), lost);
  EXPECT_EQ(horizon_after({60}), 60) << "nothing is known of a stream with two frames";
  EXPECT_EQ(horizon_after({0.125, 2, 2, 2}), 2) << "0.375, 1.125, 2";
}

// More frames than steps: they count as one, over their whole time.
TEST(SurfaceVelocity, FramesWithoutAStepBetweenThemCountAsOne) {
  SurfaceVelocity velocity(0.1);
  velocity.on_frame(0, kUp);
  velocity.on_frame(0.001, kUp);
  velocity.on_frame(0.002, kUp);
  velocity.on_step(0.0002 * kUp);
  EXPECT_NEAR(velocity.m_per_s(), 0.1, 1e-15);
  const double first = velocity.on_frame(0.003, kUp).y(), second = velocity.on_frame(0.004, kUp).y();
  EXPECT_NEAR(first + second, 0.0002, 1e-17);
  velocity.on_step(Vec3::Zero());
  EXPECT_NEAR(velocity.m_per_s(), 0.1, 1e-15);
}

}  // namespace
}  // namespace remote_touch::surface_velocity_test
