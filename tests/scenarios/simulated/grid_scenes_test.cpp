#include "scenarios/simulated/grid_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/trajectory.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

// A lift against its closed form: the motion is a function of time, which frames sample.
namespace remote_touch::lifts_test {
namespace {

constexpr double kRates_hz[] = {15, 30, 60, 90, 1000, 7.5, 29.97};

// The lift of Fig 4.12 after a wait.
LiftMotion::Settings lift() {
  return {0.2, 0.05, 0.1, 0.5, 3, 1 / 3.0};
}

// y = y_0 + v_0 t + a t (t + 1 / u) / 2 from one update before the end of the rise on.
double closed_form(const LiftMotion::Settings& s, double time_s) {
  const double since_s = std::clamp(time_s - s.wait_s, 0.0, s.rise_s + s.acceleration_s);
  const double step_s = 1 / s.update_rate_hz, t = since_s - s.rise_s;
  const double accelerated = t > -step_s ? 0.5 * s.acceleration_m_per_s2 * t * (t + step_s) : 0;
  return -s.start_depth_m + s.start_velocity_m_per_s * since_s + accelerated;
}

// --- a function of time ---

TEST(LiftMotion, IsTheClosedFormAtAnyTime) {
  LiftMotion::Settings odd = lift();  // no update where a part begins or ends
  odd.wait_s = 0.123, odd.rise_s = 0.4567, odd.acceleration_s = 0.2345, odd.update_rate_hz = 17;
  const LiftMotion::Settings receding{0.1, -0.02, -0.3, 0.1};  // from above zero
  for (const LiftMotion::Settings& s : {lift(), odd, receding}) {
    const LiftMotion motion(s);
    for (int tick = 0; tick < 1500; ++tick)
      EXPECT_NEAR(motion.height_m(0.001 * tick), closed_form(s, 0.001 * tick), 1e-14) << tick;
  }
}

// Checks the frames of a scene at each rate, and the surface between the frames.
template <class Made>
void expect_the_same_motion(typename Made::Settings settings, const LiftMotion::Settings& expected) {
  settings.noise_sigma_m = 0, settings.truth = SurfaceTime::moving;
  settings.grid = {3, 3, 0.01, 0, 0};
  for (const double rate_hz : kRates_hz) {
    settings.frame_rate_hz = rate_hz;
    const Made scene(settings, {1, 2, 3}, scenes::kernels());
    for (int frame = 0; frame < scene.frame_count(); ++frame)
      ASSERT_NEAR(scene.cloud(frame).y[4], closed_form(expected, scene.captured_s(frame)), 1e-14)
          << rate_hz << " " << frame;
    EXPECT_NEAR(scene.cloud(scene.frame_count() - 1).y[4], closed_form(expected, 100), 1e-14) << "at rest";
    for (int tick = 0; tick < 1200; ++tick) {
      ASSERT_NEAR(scene.surface_height(0, 0, 0.001 * tick), closed_form(expected, 0.001 * tick), 1e-14)
          << rate_hz << " " << tick;
      ASSERT_NEAR(scene.signed_distance({0, 0.1, 0}, 0.001 * tick), 0.1 - closed_form(expected, 0.001 * tick),
                  1e-14);
    }
  }
}

TEST(LiftMotion, IsTheSameAtEveryFrameRate) {
  MovingLift::Settings plane;
  plane.lift = lift();
  expect_the_same_motion<MovingLift>(plane, lift());
  MovingShape::Settings shape;
  shape.motion.lift = lift();
  expect_the_same_motion<MovingShape>(shape, lift());
}

TEST(LiftMotion, EventsOfAShapeAreAtTheirTimesAtAnyFrameRate) {
  for (const double rate_hz : {15.0, 30.0, 60.0}) {
    MovingShape::Settings s;
    s.frame_rate_hz = rate_hz, s.empty_frame_at_s = 0.4, s.vanish_at_s = 0.8;
    const MovingShape shape(s, {1, 2, 3}, scenes::kernels());
    for (int frame = 0; frame < shape.frame_count(); ++frame) {
      const bool is_empty = frame == std::lround(0.4 * rate_hz),
                 is_gone = frame >= std::lround(0.8 * rate_hz);
      EXPECT_EQ(shape.cloud(frame).size() == 0, is_empty || is_gone) << rate_hz << " " << frame;
    }
  }
}

// --- the heights that 4.3.2 gives ---

// The heights at frames that coincide with the updates are the sums of 4.3.2, bit for bit.
TEST(LiftMotion, HasThePrintedHeights) {
  for (const double rate_hz : {30.0, 90.0, 130.0}) {
    for (const int rise : {0, 13, 15, 45}) {
      LiftMotion::Settings s = lift();
      s.wait_s = 7 / rate_hz, s.rise_s = rise / rate_hz, s.acceleration_s = 10 / rate_hz;
      s.update_rate_hz = rate_hz;
      const LiftMotion motion(s);
      ASSERT_EQ(motion.frame_count(rate_hz), 7 + rise + 10 + 1);
      double velocity = s.start_velocity_m_per_s, height = -s.start_depth_m;
      for (int frame = 0; frame <= 7 + rise + 10 + 3; ++frame) {
        if (frame >= 7 && frame <= 7 + rise) height = -s.start_depth_m + (frame - 7) * (velocity / rate_hz);
        if (frame > 7 + rise && frame <= 7 + rise + 10)
          velocity += s.acceleration_m_per_s2 / rate_hz, height += velocity / rate_hz;
        EXPECT_EQ(motion.height_of_frame_m(frame, rate_hz), height) << rate_hz << " " << rise << " " << frame;
      }
    }
  }
}

TEST(LiftMotion, MayBeLinearBetweenUpdates) {
  LiftMotion::Settings s = lift();
  const LiftMotion parabola(s);
  s.between_updates = LiftMotion::BetweenUpdates::line;
  const LiftMotion line(s);
  for (int tick = 0; tick < 1200; ++tick) {
    const double place = 0.001 * tick * 30, before_s = std::floor(place) / 30, after_s = before_s + 1 / 30.0;
    const double part = place - std::floor(place), low = parabola.height_m(before_s);
    EXPECT_NEAR(line.height_m(0.001 * tick), low + part * (parabola.height_m(after_s) - low), 1e-14) << tick;
  }
}

TEST(LiftMotion, NamesItsPhases) {
  const auto parts = LiftMotion(lift()).phases();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "the rise");
  EXPECT_NEAR(parts[0].begins_s, 0.2, 1e-12);
  EXPECT_NEAR(parts[1].begins_s, 0.7, 1e-12);
  EXPECT_NEAR(parts[1].ends_s, 0.7 + 1 / 3.0, 1e-12);
  LiftMotion::Settings steady = lift();
  steady.acceleration_m_per_s2 = 0;
  EXPECT_NEAR(LiftMotion(steady).phases().at(0).ends_s, 0.7 + 1 / 3.0, 1e-12);
  steady.start_velocity_m_per_s = 0;
  EXPECT_TRUE(LiftMotion(steady).phases().empty());
}

// --- the proxy on it: (4.14) at every rate ---

TEST(LiftMotion, PopsThroughAtTheBoundOfEachFrameRate) {
  for (const double rate_hz : {15.0, 30.0, 60.0}) {
    for (const double of_bound : {0.97, 1.03}) {
      const double acceleration = of_bound * 0.00499 * rate_hz * rate_hz;
      const Trace trace = simulate(Experiment::load(
          "fig4.12", {"scenario.noise_sigma_m=0", "scenario.start_velocity_m_per_s=0.05",
                      "scenario.start_depth_m=0.025", "scenario.frame_rate_hz=" + std::to_string(rate_hz),
                      "scenario.acceleration_m_per_s2=" + std::to_string(acceleration)}));
      EXPECT_EQ(trace.signed_distance_m.back() < 0, of_bound > 1) << rate_hz << " " << of_bound;
    }
  }
}

}  // namespace
}  // namespace remote_touch::lifts_test

namespace remote_touch::moving_shape_test {
namespace {

using Kind = Shape::Kind;

const NoiseKey kKey{1, 2, 3};
constexpr double kPi = 3.14159265358979323846;
const Kind kKinds[] = {Kind::flat, Kind::ridge, Kind::valley, Kind::sphere, Kind::ripple, Kind::corner};

MovingShape made(const MovingShape::Settings& settings, const NoiseKey& key = kKey) {
  return MovingShape(settings, key, scenes::kernels());
}

Vec3 turned(const Vec3& p, double angle_deg) {
  return Eigen::AngleAxisd(angle_deg * kPi / 180, Vec3::UnitZ()) * p;
}

// Settings of a shape of this kind, with all motions at once.
MovingShape::Settings busy(Kind kind) {
  MovingShape::Settings s;
  s.grid = {41, 31, 0.0015, 0.25, -0.5};
  s.shape.kind = kind, s.shape.slope_deg = 25, s.shape.radius_m = 0.025;
  s.motion = {8, {0, 0.02, 0.1, 4 / 30.0, -1, 4 / 30.0}, 0.05, 0.004, 3, 6, 1.5, 0.1};
  s.truth = SurfaceTime::moving;
  return s;
}

// --- a lift ---

TEST(MovingShape, AFlatLiftIsAMovingLiftBitForBit) {
  MovingLift::Settings lift;
  MovingShape::Settings shape;
  shape.grid = lift.grid, shape.noise_sigma_m = lift.noise_sigma_m;
  shape.motion.lift = lift.lift;
  for (const bool moving : {false, true}) {
    if (moving) lift.truth = SurfaceTime::moving, shape.truth = SurfaceTime::moving;
    const MovingLift one(lift, kKey, scenes::kernels());
    const MovingShape other = made(shape);
    ASSERT_EQ(other.frame_count(), one.frame_count());
    for (const int frame : {0, 1, 15, 17, 25})
      EXPECT_TRUE(scenes::same_points(one.cloud(frame), other.cloud(frame))) << frame;
    for (int tick = 0; tick < 1000; tick += 7) {
      const double time_s = 0.001 * tick;
      const Vec3 p(0.01, 1e-4 * tick - 0.05, -0.02);
      EXPECT_EQ(one.signed_distance(p, time_s), other.signed_distance(p, time_s)) << time_s;
      EXPECT_EQ(one.surface_height(0, 0, time_s), other.surface_height(0, 0, time_s)) << time_s;
    }
  }
}

// --- motions in addition to the lift, and the true surface ---

// A step along a point's normal changes the distance to the true surface by the length of the step, in any
// pose.
TEST(MovingShape, NormalsAreThoseOfTheTrueSurface) {
  for (const Kind kind : kKinds) {
    MovingShape::Settings s = busy(kind);
    EXPECT_FALSE(made(s).cloud(3).has_normals());
    s.normals = true;
    const MovingShape shape = made(s);
    EXPECT_TRUE(scenes::same_points(shape.cloud(5), made(busy(kind)).cloud(5)));
    for (const int frame : {0, 9}) {
      const PointCloud cloud = shape.cloud(frame);
      int tried = 0;
      for (std::size_t i = 0; i < cloud.size(); i += 13) {
        if (!cloud.point(i).allFinite()) continue;
        ASSERT_NEAR(cloud.normal(i).norm(), 1, 1e-12);
        // Beside a crease another side may be nearer.
        const double step_m = 1e-5;
        EXPECT_NEAR(shape.signed_distance(cloud.point(i) + step_m * cloud.normal(i), frame / 30.0), step_m,
                    1e-7)
            << static_cast<int>(kind) << " " << i;
        ++tried;
      }
      EXPECT_GT(tried, 30);
    }
  }
}

TEST(MovingShape, SlideShakeAndRockFollowTheirFormulas) {
  MovingShape::Settings s;
  s.motion.slide_velocity_m_per_s = -0.2, s.motion.shake_amplitude_m = 0.003, s.motion.shake_hz = 4;
  s.motion.rock_deg = 7, s.motion.rock_hz = 0.8, s.motion.tilt_deg = -3, s.motion.motion_from_s = 0.25;
  s.truth = SurfaceTime::moving;
  const MovingShape shape = made(s);
  EXPECT_EQ(shape.frame_count(), std::numeric_limits<int>::max());
  for (int frame = 0; frame < 40; frame += 3) {
    const double t = std::max(0.0, frame / 30.0 - 0.25);
    const Vec3 origin(-0.2 * t, 0.003 * std::sin(2 * kPi * 4 * t), 0);
    const double rotation_deg = -3 + 7 * std::sin(2 * kPi * 0.8 * t);
    const PointCloud cloud = shape.cloud(frame);
    for (std::size_t i = 0; i < cloud.size(); i += 97) {
      const int column = static_cast<int>(i) % 80, row = static_cast<int>(i) / 80;
      const Vec3 expected = origin + turned({s.grid.x(column), 0, s.grid.z(row)}, rotation_deg);
      EXPECT_LT((cloud.point(i) - expected).norm(), 1e-15) << frame;
    }
    // The height is that of a tilted plane, also over positions beyond its border.
    for (const double x : {0.0, 0.03, -1.0})
      EXPECT_NEAR(shape.surface_height(x, 0.01, frame / 30.0),
                  origin.y() + std::tan(rotation_deg * kPi / 180) * (x - origin.x()), 1e-14);
  }
  EXPECT_EQ(shape.surface_height(0, 0, 0.1), shape.surface_height(0, 0, 0.2)) << "before it begins";
}

TEST(MovingShape, NoiseFreePointsLieOnTheTrueSurfaceAtEveryFrame) {
  for (const Kind kind : kKinds) {
    const MovingShape shape = made(busy(kind));
    for (const int frame : {0, 2, 5, 9, 23}) {
      const PointCloud cloud = shape.cloud(frame);
      const double t = shape.captured_s(frame);
      int measured = 0;
      for (std::size_t i = 0; i < cloud.size(); i += 5) {
        if (!cloud.is_measured(i)) continue;
        ++measured;
        const Vec3 p = cloud.point(i);
        ASSERT_NEAR(shape.signed_distance(p, t), 0, 2e-12) << static_cast<int>(kind) << " frame " << frame;
        // A ball that is turned overhangs at its rim.
        const bool lies_on_top = shape.signed_distance(p + Vec3(0, 0.001, 0), t) > 0.0005;
        if (lies_on_top) {
          ASSERT_NEAR(shape.surface_height(p.x(), p.z(), t), p.y(), 1e-11);
        }
      }
      EXPECT_GT(measured, 100);
    }
  }
}

// The moving truth between frames is the surface where the motion has carried it. The truth of the newest
// frame does not change.
TEST(MovingShape, TheTruthMovesBetweenFramesOrIsThatOfTheNewest) {
  MovingShape::Settings s = busy(Kind::ridge);
  const MovingShape moving = made(s);
  s.truth = SurfaceTime::newest_frame;
  const MovingShape newest = made(s);
  const Vec3 p(0.004, 0.03, 0.002);
  for (int frame = 3; frame < 12; ++frame) {
    const double t = moving.captured_s(frame), next = moving.captured_s(frame + 1);
    EXPECT_NEAR(moving.signed_distance(p, t), newest.signed_distance(p, t), 1e-15);
    EXPECT_EQ(newest.signed_distance(p, t + 0.03), newest.signed_distance(p, t));
    EXPECT_NE(moving.signed_distance(p, t + 0.03), moving.signed_distance(p, t));
    EXPECT_NEAR(moving.signed_distance(p, next - 1e-9), moving.signed_distance(p, next), 1e-8);
  }
}

// --- points ---

TEST(MovingShape, LayersFollowEachOtherBelow) {
  MovingShape::Settings s = busy(Kind::valley);
  s.layers = 3, s.layer_spacing_m = 0.012;
  const MovingShape shape = made(s);
  s.layers = 1;
  const PointCloud all = shape.cloud(7), first = made(s).cloud(7);
  const double rotation_deg = 8 + 6 * std::sin(2 * kPi * 1.5 * (7 / 30.0 - 0.1));
  ASSERT_EQ(all.size(), 3 * first.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double below = 0.012 * static_cast<double>(i / first.size());
    const Vec3 expected = first.point(i % first.size()) - below * turned(Vec3::UnitY(), rotation_deg);
    ASSERT_LT((all.point(i) - expected).norm(), 1e-15);
  }
  for (const double y : {-0.05, 0.0, 0.05})  // the true surface is the first layer
    EXPECT_EQ(shape.signed_distance({0, y, 0}, 0.2), made(s).signed_distance({0, y, 0}, 0.2));
}

TEST(MovingShape, NoiseBelongsToKeyAndFrame) {
  MovingShape::Settings s = busy(Kind::ridge);
  const MovingShape clean = made(s);
  s.noise_sigma_m = 0.002;
  const MovingShape one = made(s), same = made(s), other = made(s, {9, 2, 3});
  EXPECT_TRUE(scenes::same_points(one.cloud(4), same.cloud(4)));
  EXPECT_FALSE(scenes::same_points(one.cloud(4), other.cloud(4)));
  s.redraw_noise = false;
  const MovingShape fixed = made(s);
  EXPECT_TRUE(scenes::same_points(fixed.cloud(0), one.cloud(0)));
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < fixed.cloud(4).size(); ++i) {
    const auto noise = [&](const MovingShape& noisy, int frame) -> Vec3 {
      return noisy.cloud(frame).point(i) - clean.cloud(frame).point(i);
    };
    if (i % 40 == 0) {
      EXPECT_LT((noise(fixed, 4) - noise(fixed, 0)).norm(), 1e-15);
      EXPECT_GT((noise(one, 4) - noise(one, 0)).norm(), 1e-6);
      squares += noise(one, 4).squaredNorm(), count += 3;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.002, 5 * 0.002 / std::sqrt(2 * count));
}

TEST(MovingShape, SearchesFindThePointsOfTheCloud) {
  for (const Kind kind : kKinds) {
    for (const bool level : {true, false}) {
      MovingShape::Settings s = busy(kind);
      if (level) s.motion = {}, s.motion.shake_amplitude_m = 0.004;
      s.noise_sigma_m = 0.001;
      const MovingShape shape = made(s);
      const auto points = shape.points(5);
      EXPECT_EQ(dynamic_cast<const NoisyGridSearch*>(points.get()) != nullptr, level && kind == Kind::flat);
      const PointCloud cloud = shape.cloud(5);
      const BruteForceSearch oracle(cloud);
      ASSERT_EQ(points->size(), cloud.size());
      GatheredPoints found, expected;
      for (GatheredPoints* out : {&found, &expected}) out->reserve(cloud.size(), false, false);
      for (std::size_t i = 0; i < cloud.size(); i += 50) {
        if (!cloud.is_measured(i)) continue;
        found.clear(), expected.clear();
        points->gather({cloud.point(i), 0.008}, scenes::kernels(), found);
        oracle.gather({cloud.point(i), 0.008}, scenes::kernels(), expected);
        EXPECT_EQ(found.size(), expected.size());
        EXPECT_GT(found.size(), 0u);
      }
      found.clear();
      points->gather({Vec3(0, 0, std::nan("")), 1}, scenes::kernels(), found);
      EXPECT_EQ(found.size(), 0u);
    }
  }
}

// --- frames without points ---

TEST(MovingShape, VanishesForGood) {
  MovingShape::Settings s = busy(Kind::flat);
  s.vanish_at_s = 5 / 30.0;
  const MovingShape shape = made(s);
  s.vanish_at_s = -1;
  const MovingShape stays = made(s);
  ASSERT_EQ(shape.frame_count(), 6);
  EXPECT_TRUE(scenes::same_points(shape.cloud(4), stays.cloud(4)));
  EXPECT_EQ(shape.cloud(5).size(), 0u);
  EXPECT_EQ(shape.points(5)->size(), 0u);
  const double gone_s = shape.captured_s(5);
  EXPECT_EQ(shape.signed_distance({0, 0.01, 0}, gone_s - 0.001),
            stays.signed_distance({0, 0.01, 0}, gone_s - 0.001));
  EXPECT_TRUE(std::isnan(shape.signed_distance({0, 0.01, 0}, gone_s)));
  EXPECT_EQ(shape.surface_height(0, 0, gone_s + 3), stays.surface_height(0, 0, gone_s));
}

TEST(MovingShape, OneFrameMayBeEmpty) {
  MovingShape::Settings s;
  s.empty_frame_at_s = 4 / 30.0;
  const MovingShape rests = made(s);
  ASSERT_EQ(rests.frame_count(), 6);
  EXPECT_EQ(rests.cloud(4).size(), 0u);
  EXPECT_TRUE(scenes::same_points(rests.cloud(3), rests.cloud(5)));
  EXPECT_EQ(rests.signed_distance({0, 0.01, 0}, 4.5 / 30), 0.01) << "it is there, and not seen";
  s = busy(Kind::ripple), s.empty_frame_at_s = 4 / 30.0;
  const MovingShape moves = made(s);
  EXPECT_EQ(moves.cloud(4).size(), 0u);
  EXPECT_GT(moves.cloud(5).size(), 0u);
}

// --- a hand that presses ---

TEST(MovingShape, AHandCanPressEveryShape) {
  for (const Kind kind : kKinds) {
    for (const bool moving : {false, true}) {
      MovingShape::Settings s = busy(kind);
      if (!moving) s.motion = {};
      s.vanish_at_s = 40 / 30.0;
      const MovingShape shape = made(s);
      Press::Settings press;
      press.press_at_s = 0, press.surface = SurfaceTime::moving;
      const Press hand(press, shape);
      for (int tick = 0; tick < 3000; tick += 11) ASSERT_TRUE(hand.at(0.001 * tick).position_W.allFinite());
      EXPECT_LT(shape.signed_distance(hand.at(0.5).position_W, 0.5), 0);
    }
  }
}

TEST(MovingShape, RefusesSlopesThatStandUpright) {
  MovingShape::Settings s;
  EXPECT_EQ(validate(s), "");
  s.shape.kind = Kind::ridge, s.shape.slope_deg = 60, s.motion.tilt_deg = -20;
  EXPECT_EQ(validate(s), "");
  s.motion.rock_deg = 10;
  EXPECT_HAS(validate(s), "tilt_deg = -20");
  EXPECT_HAS(validate(s), "below 89 degrees together, not 90.0");
  s.shape.kind = Kind::sphere;
  EXPECT_EQ(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::moving_shape_test
