// The motions of a scripted hand: along lines, on surfaces, over images, through poses, and at random.
#include "runners/experiment/hand/trajectory.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/image_motions.h"
#include "scenarios/simulated/camera_scenes.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"

namespace remote_touch::trajectory_test {
namespace {

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, NoiseKey{}, scenes::kernels());
}

// A scenario of points without a true surface.
class PointsOnly final : public Scenario {
 public:
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int) const override { return scenes::flat_grid(5); }
  double signed_distance(const Vec3&, double) const override { return std::nan(""); }
};

void expect_at(const Vec3& got, const Vec3& want) {
  EXPECT_LT((got - want).norm(), 1e-15) << got.transpose() << " instead of " << want.transpose();
}

TEST(PolylinePath, CanJumpWaitAndEnd) {
  PolylinePath path({0, 0, 0});
  path.wait(1);
  path.go_to({5, 0, 0}, 0);  // a jump at 1 s
  path.wait(0.5);
  path.go_to({5, 0, 0}, 3);  // a piece of no length takes no time
  path.go_to({5, 1, 0}, 2);
  EXPECT_DOUBLE_EQ(path.duration_s(), 2);
  expect_at(path.at(-3), {0, 0, 0});
  expect_at(path.at(std::nextafter(1.0, 0.0)), {0, 0, 0});
  expect_at(path.at(1), {5, 0, 0});  // the jump is done at its moment
  expect_at(path.at(1.49), {5, 0, 0});
  expect_at(path.at(1.75), {5, 0.5, 0});
  expect_at(path.at(2), {5, 1, 0});
  expect_at(path.at(1e6), {5, 1, 0});
}

TEST(Waypoints, ARowIsAPositionAndTheSpeedOfTheMotionToIt) {
  const FlatGrid scene = made<FlatGrid>();
  const Waypoints device({{0, 0.01, 0, 7, 0.1, 0.01, 0, 0.05, 0.1, -0.01, 0, 0, 0.1, -0.01, 0.3, 0.1}},
                         scene);
  EXPECT_DOUBLE_EQ(device.duration_s(), 2 + 3);
  expect_at(device.at(0).position_W, {0, 0.01, 0});
  expect_at(device.at(1.5).position_W, {0.075, 0.01, 0});
  expect_at(device.at(2).position_W, {0.1, -0.01, 0});
  expect_at(device.at(4).position_W, {0.1, -0.01, 0.2});
  expect_at(device.at(9).position_W, {0.1, -0.01, 0.3});
}

// The lift rises with 0.1 m/s from -0.05 m; from frame 15 on its speed grows by 0.1 m/s a frame.
TEST(Press, FollowsFramesOrTheMovingPlane) {
  const MovingLift lift = made<MovingLift>();
  Press::Settings s;
  s.start_m = {0.01, 0.02, 0.03};
  const Press stepwise(s, lift);
  s.surface = SurfaceTime::moving;
  const Press smooth(s, lift);
  for (const Press* device : {&stepwise, &smooth}) {
    expect_at(device->at(0).position_W, s.start_m);
    expect_at(device->at(0.4999).position_W, s.start_m);
    expect_at(device->at(0.5).position_W, {0.01, 0 - 0.03, 0.03});
    expect_at(device->at(100).position_W, {0.01, 1.0 / 30 + 3.0 * 55 / 900 - 0.03, 0.03});
  }
  const double frame_16 = 0.2 / 30, frame_17 = 0.5 / 30;
  expect_at(stepwise.at(0.533).position_W, {0.01, -0.03, 0.03});
  expect_at(stepwise.at(16 / 30.0).position_W, {0.01, frame_16 - 0.03, 0.03});
  expect_at(stepwise.at(0.566).position_W, {0.01, frame_16 - 0.03, 0.03});
  expect_at(smooth.at(16 / 30.0).position_W, {0.01, frame_16 - 0.03, 0.03});
  const double sag = 3.0 / 8 / 900;  // sag of the parabola midway between two updates
  expect_at(smooth.at(16.5 / 30).position_W, {0.01, 0.5 * (frame_16 + frame_17) - sag - 0.03, 0.03});
}

TEST(FollowSurface, StaysInsideAWaveByItsDepth) {
  const TriangleWave wave = made<TriangleWave>();
  FollowSurface::Settings s;
  s.from_m = {-0.19425, 0, 0}, s.to_m = {0.19575, 0, 0};  // corners, so that all corners are sampled
  const FollowSurface device(s, wave);
  double deepest = 0;
  for (double t = 0.6; t < device.duration_s() - 0.6; t += 0.001) {
    const Vec3 hip = device.at(t).position_W;
    // Samples are 1e-4 m apart, 1.4e-4 m along the flanks. Their circles of 5 mm sag by that squared over 8
    // times 5 mm between two samples. The straight piece between two positions cuts the corner by as much.
    ASSERT_LE(wave.signed_distance(hip, t), -s.depth_m + 1e-6) << hip.transpose();
    deepest = std::min(deepest, wave.signed_distance(hip, t));
    const double moved = (device.at(t + 1e-4).position_W - hip).norm();
    ASSERT_LE(moved, 1e-4 * s.speed_m_per_s * (1 + 1e-9));
  }
  // The piece between two positions passes at most half a sample lower, where two circles meet below a peak.
  EXPECT_GT(deepest, -s.depth_m - 0.5e-4);
}

TEST(FollowSurface, LiftsOffOverSteps) {
  const CameraScene scene = made<CameraScene>();
  FollowSurface::Settings s;
  s.from_m = {0, 0, -0.4}, s.to_m = {0, 0, 0.35};
  const FollowSurface device(s, scene);
  int over_steps = 0, inside = 0;
  for (double t = 0; t < device.duration_s(); t += 0.001) {
    const Vec3 hip = device.at(t).position_W;
    // Walls of ramp (0.06 m high) and box (0.08 m); 2e-4 for the sampling of the line.
    for (const auto& [z, top] : {std::pair(-0.18, 0.06), {0.14, 0.08}, {0.26, 0.08}}) {
      if (std::abs(hip.z() - z) > s.step_margin_m - 2e-4) continue;
      ASSERT_GE(hip.y(), top + s.clearance_m - 1e-3)
          << hip.transpose();  // the ramp is 0.4 mm lower 1 mm away
      ++over_steps;
    }
    // The HIP is inside away from walls: on level parts, and on the slope of 0.4, where depth is measured
    // along the normal.
    const auto expect_depth = [&](double low, double high, double surface, double below) {
      if (hip.z() < low || hip.z() > high) return;
      ASSERT_NEAR(hip.y(), surface - below, 1e-6) << hip.transpose();
      ++inside;
    };
    expect_depth(-0.39, -0.34, 0, s.depth_m);
    expect_depth(-0.31, -0.20, 0.4 * (hip.z() + 0.33), s.depth_m * std::sqrt(1.16));
    expect_depth(-0.16, 0.12, 0, s.depth_m);
    expect_depth(0.16, 0.24, 0.08, s.depth_m);
    expect_depth(0.28, 0.34, 0, s.depth_m);
  }
  EXPECT_GT(over_steps, 600);
  EXPECT_GT(inside, 5000);
}

// The depth is that below the true surface, as it moves or as the newest frame shows it.
TEST(FollowSurface, FollowsASurfaceThatRisesAndSinksAsAWhole) {
  MovingShape::Settings moves;
  moves.shape.kind = Shape::Kind::ripple;
  moves.motion.shake_amplitude_m = 0.01, moves.motion.shake_hz = 1,
  moves.motion.lift.start_velocity_m_per_s = 0.02;
  moves.motion.lift.rise_s = 1;
  for (const SurfaceTime truth : {SurfaceTime::moving, SurfaceTime::newest_frame}) {
    moves.truth = truth;
    const MovingShape scene(moves, NoiseKey{1}, scenes::kernels());
    const FollowSurface device({{-0.04, 0, 0}, {0.04, 0, 0}}, scene);
    double most_m = 0;
    for (double t = 0.6; t < device.duration_s() - 0.6; t += 0.01)
      most_m = std::max(most_m, std::abs(scene.signed_distance(device.at(t).position_W, t) + 0.005));
    EXPECT_LT(most_m, 1e-4) << "the spacing of its samples";
  }
}

ImageScan::Settings scan_of(int row, int first_column = -1, int last_column = -1) {
  ImageScan::Settings s;
  s.row = row, s.first_column = first_column, s.last_column = last_column;
  return s;
}

TEST(ImageScan, ObeysGivenColumns) {
  const CameraScene scene = made<CameraScene>();
  const ImageScan given(scan_of(240, 300, 340), scene);
  EXPECT_EQ(given.row(), 240);
  ASSERT_EQ(given.patches().size(), 1u);
  EXPECT_EQ(given.patches()[0].first_column, 300);
  EXPECT_EQ(given.patches()[0].last_column, 340);
}

// --- poses and random motions ---

const double kDegree = std::acos(-1.0) / 180;

Poses poses(std::vector<double> rows) {
  return Poses({std::move(rows)}, made<FlatGrid>());
}

void expect_at(const DeviceState& got, const Vec3& place, const Eigen::Quaterniond& orientation) {
  EXPECT_LT((got.position_W - place).norm(), 1e-15) << got.position_W.transpose();
  EXPECT_LT(got.orientation_W.angularDistance(orientation), 1e-7) << got.orientation_W;
  EXPECT_LT((got.orientation_W.toRotationMatrix() - orientation.toRotationMatrix()).norm(), 2e-15);
  EXPECT_NEAR(got.orientation_W.norm(), 1, 4e-16);
}

Eigen::Quaterniond about(const Vec3& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kDegree, axis.normalized()));
}

TEST(Poses, GoStraightAndTurnEvenly) {
  const Poses device = poses({0,   0.1,  0, 0,  0,   0, 9,    //
                              0,   -0.1, 0, 0,  0,   0, 2,    //
                              0,   -0.1, 0, 0,  30,  0, 3,    //
                              0.3, 0,    0, 0,  -60, 0, 0.5,  //
                              1,   1,    1, 90, 0,   0, 0});
  EXPECT_EQ(device.duration_s(), 5.5);
  const Vec3 y = Vec3::UnitY();
  expect_at(device.at(-1), {0, 0.1, 0}, about(y, 0));
  expect_at(device.at(0.5), {0, 0.05, 0}, about(y, 0));
  expect_at(device.at(2), {0, -0.1, 0}, about(y, 0));
  expect_at(device.at(3), {0, -0.1, 0}, about(y, 10));
  expect_at(device.at(5), {0, -0.1, 0}, about(y, 30));
  expect_at(device.at(5.25), {0.15, -0.05, 0}, about(y, -15));
  expect_at(device.at(5.5), {1, 1, 1}, about(Vec3::UnitX(), 90));  // jumped, and stays
  expect_at(device.at(99), {1, 1, 1}, about(Vec3::UnitX(), 90));
}

// Slerp turns from one orientation to the other about a fixed axis.
TEST(Poses, TakeTheShorterWayRound) {
  const Poses device = poses({0, 0, 0, 20, -50, 80, 0, 0, 0, 0, -100, 30, 10, 1, 0, 0, 0, 0, 0, 200, 1});
  const Eigen::Quaterniond a = about({20, -50, 80}, Vec3(20, -50, 80).norm());
  const Eigen::Quaterniond b = about({-100, 30, 10}, Vec3(-100, 30, 10).norm());
  for (double fraction = 0; fraction < 1; fraction += 0.07)
    expect_at(device.at(fraction), {0, 0, 0}, a.slerp(fraction, b));
  // 200 degrees are 160 the other way.
  const Eigen::Quaterniond c = about({0, 0, 1}, -160);
  for (double fraction = 0; fraction < 1; fraction += 0.07)
    expect_at(device.at(1 + fraction), {0, 0, 0}, b.slerp(fraction, c));
}

RandomMotion motion_of(const RandomMotion::Settings& settings) {
  return RandomMotion(settings, made<FlatGrid>());
}

TEST(RandomMotion, StaysInItsBoxAndBelowItsSpeed) {
  RandomMotion::Settings s;
  s.centre_m = {1, 2, 3}, s.extent_m = {0.02, 0.05, 0.01}, s.max_rotation_deg = 40, s.duration_s = 200;
  const RandomMotion device = motion_of(s);
  Vec3 max_width = Vec3::Zero();
  double max_speed = 0, max_rotation = 0;
  for (double t = 0; t < s.duration_s; t += 0.01) {
    const DeviceState now = device.at(t), next = device.at(t + 0.001);
    max_width = max_width.cwiseMax((now.position_W - s.centre_m).cwiseAbs());
    max_speed = std::max(max_speed, (next.position_W - now.position_W).norm() / 0.001);
    max_rotation = std::max(max_rotation, now.orientation_W.angularDistance(Eigen::Quaterniond::Identity()));
    ASSERT_NEAR(now.orientation_W.norm(), 1, 4e-16);
    ASSERT_LT(now.orientation_W.angularDistance(next.orientation_W), 0.01) << "smooth";
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(max_width[axis], s.extent_m[axis]);
    EXPECT_GT(max_width[axis], 0.8 * s.extent_m[axis]);
  }
  EXPECT_LE(max_speed, s.speed_m_per_s * (1 + 1e-9));
  EXPECT_GT(max_speed, 0.5 * s.speed_m_per_s);
  EXPECT_LE(max_rotation, s.max_rotation_deg * kDegree * (1 + 1e-9));
  EXPECT_GT(max_rotation, 0.5 * s.max_rotation_deg * kDegree);
  EXPECT_EQ(device.at(3).position_W, motion_of(s).at(3).position_W);
  s.seed = 2;
  EXPECT_GT((device.at(3).position_W - motion_of(s).at(3).position_W).norm(), 1e-3);
}

// --- refusals ---

// A motion over a surface needs to know how high it is, and one that does not change along its line. A scan
// needs pixels that are supported on all sides.
TEST(Trajectories, RefuseScenesThatTheyCannotFollow) {
  const PointsOnly points;
  const FlatGrid unorganised = made<FlatGrid>();
  const CameraScene image = made<CameraScene>();
  MovingShape::Settings slides, rocks;
  slides.shape.kind = Shape::Kind::ridge, slides.motion.slide_velocity_m_per_s = 0.01;
  rocks.motion.rock_deg = 5;
  // The heart beats between the ends and the middle of the line, which are on its table.
  const BeatingHeart heart = made<BeatingHeart>();
  EXPECT_THROW(Press({}, points), InputError);
  EXPECT_THROW(FollowSurface({}, points), InputError);
  EXPECT_THROW(FollowSurface({}, made<MovingShape>(slides)), InputError);
  EXPECT_THROW(FollowSurface({}, made<MovingShape>(rocks)), InputError);
  EXPECT_THROW(FollowSurface({{-0.15, 0, 0}, {0.25, 0, 0}}, heart), InputError);
  EXPECT_THROW(ImageScan({}, unorganised), InputError);
  EXPECT_THROW(ImageScan(scan_of(480), image), InputError);
  EXPECT_THROW(ImageScan(scan_of(0), image), InputError);
}

// A line of no length has no direction, a box of no extent no motion: the hand would be nowhere. The square
// of 1e-200 is 0.
TEST(Trajectories, RefuseSettingsThatAreNoMotion) {
  const auto line_to = [](double x, double z) {
    return validate(FollowSurface::Settings{{0, 0, 0.2}, {x, 0.3, z}});
  };
  const auto turned = [](double degrees, double duration_s) {
    return validate(Poses::Settings{{0, 0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 10 + degrees, 0, duration_s}});
  };
  const auto in_box = [](double x) {
    RandomMotion::Settings s;
    s.extent_m = {x, 0, 0};
    return validate(s);
  };
  const auto scanned = [](int first, int last) { return validate(scan_of(240, first, last)); };
  const struct {
    const char* what;
    std::string got;
    bool is_refused;
  } rows[] = {{"no waypoints", validate(Waypoints::Settings{{}}), true},
              {"a negative speed", validate(Waypoints::Settings{{0, 0, 0, -1}}), true},
              {"a line of no length", line_to(0, 0.2), true},
              {"a line of next to no length", line_to(1e-200, 0.2), true},
              {"a line", line_to(0, 0.3), false},
              {"columns that go back", scanned(20, 10), true},
              {"no poses", validate(Poses::Settings{{}}), true},
              {"a negative duration", validate(Poses::Settings{{0, 0, 0, 0, 0, 0, -1}}), true},
              {"less than half a turn", turned(179, 1), false},
              {"half a turn", turned(180, 1), true},
              {"half a turn back", turned(-180, 1), true},
              {"a jump, which goes no way", turned(180, 0), false},
              {"next to no box", in_box(1e-7), true},
              {"no box", in_box(0), true},
              {"a box", in_box(0.01), false}};
  for (const auto& row : rows) EXPECT_EQ(row.got != "", row.is_refused) << row.what << ": " << row.got;
  EXPECT_EQ(line_to(0, 0.2), "to_m: expected another x or z than that of from_m");
}

}  // namespace
}  // namespace remote_touch::trajectory_test
