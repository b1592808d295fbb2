#include "runners/experiment/hand/trajectory.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
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

TEST(PolylinePath, EachPieceHasItsSpeed) {
  PolylinePath path({1, 0, 0});
  path.go_to({1, 0.3, 0.4}, 0.25);  // 2 s
  path.go_to({1, 0.3, 0}, 0.8);     // 0.5 s
  EXPECT_DOUBLE_EQ(path.duration_s(), 2.5);
  expect_at(path.at(0), {1, 0, 0});
  expect_at(path.at(1), {1, 0.15, 0.2});
  expect_at(path.at(2), {1, 0.3, 0.4});
  expect_at(path.at(2.125), {1, 0.3, 0.3});
  expect_at(path.at(2.5), {1, 0.3, 0});
  expect_at(path.end(), {1, 0.3, 0});
}

TEST(PolylinePath, CanJumpWaitAndEnd) {
  PolylinePath path({0, 0, 0});
  path.wait(1);
  path.go_to({5, 0, 0}, 0);  // a jump at 1 s
  path.wait(0.5);
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

TEST(PolylinePath, PieceOfNoLengthTakesNoTime) {
  PolylinePath path({0, 0, 0});
  path.go_to({0, 0, 0}, 1);
  path.go_to({1, 0, 0}, 1);
  EXPECT_EQ(path.duration_s(), 1);
  expect_at(path.at(0), {0, 0, 0});
  expect_at(path.at(0.5), {0.5, 0, 0});
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
  EXPECT_EQ(validate(Waypoints::Settings{}), "");
  EXPECT_NE(validate(Waypoints::Settings{{}}), "");
  EXPECT_NE(validate(Waypoints::Settings{{0, 0, 0, -1}}), "");
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

TEST(FollowSurface, KeepsItsDepthAndSpeedOnAFlat) {
  const FlatGrid scene = made<FlatGrid>();
  const FollowSurface device({}, scene);
  const double down = (0.02 + 0.005) / 0.05;  // time from the clearance to the depth, at 5 cm/s
  EXPECT_NEAR(device.duration_s(), down + 0.2 / 0.05 + down, 1e-12);
  expect_at(device.at(0).position_W, {-0.1, 0.02, 0});
  for (const double t : {0.0, 0.3, 1.7, 3.9})
    EXPECT_LT((device.at(down + t).position_W - Vec3(-0.1 + 0.05 * t, -0.005, 0)).norm(), 1e-13) << t;
  EXPECT_LT((device.at(99).position_W - Vec3(0.1, 0.02, 0)).norm(), 1e-13);
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

TEST(FollowSurface, RefusesASurfaceThatChangesAlongItsLine) {
  MovingShape::Settings slides, rocks;
  slides.shape.kind = Shape::Kind::ridge, slides.motion.slide_velocity_m_per_s = 0.01;
  rocks.motion.rock_deg = 5;
  for (const auto& settings : {slides, rocks})
    EXPECT_THROW(FollowSurface({}, MovingShape(settings, NoiseKey{1}, scenes::kernels())), InputError);
  // The heart beats between the ends and the middle of the line, which are on its table.
  const BeatingHeart heart({}, NoiseKey{1}, scenes::kernels());
  EXPECT_THROW(FollowSurface({{-0.15, 0, 0}, {0.25, 0, 0}}, heart), InputError);
}

// A line of no length has no direction: the hand would be nowhere.
TEST(FollowSurface, RefusesEndsThatDifferOnlyInHeight) {
  FollowSurface::Settings s;
  EXPECT_EQ(validate(s), "");
  s.from_m = {0.1, 0, 0.2}, s.to_m = {0.1, 0.3, 0.2};
  EXPECT_EQ(validate(s), "to_m: expected another x or z than that of from_m");
  s.to_m.x() += 1e-200;  // the square of this length is 0
  EXPECT_NE(validate(s), "");
  s.to_m.z() = 0.3;
  EXPECT_EQ(validate(s), "");
}

TEST(HeightFields, PressAndFollowSurfaceRefuseOtherScenes) {
  const PointsOnly scene;
  EXPECT_THROW(Press({}, scene), InputError);
  EXPECT_THROW(FollowSurface({}, scene), InputError);
}

std::size_t pixel(int u, int v) {
  return static_cast<std::size_t>(v) * 640 + static_cast<std::size_t>(u);
}

TEST(ImageScan, TouchesWhatWasSeenWithoutGaps) {
  const CameraScene scene = made<CameraScene>();
  const PointCloud cloud = scene.cloud(0);
  const CameraIntrinsics& camera = cloud.image->camera;
  // Rows 200 and 280 cross ramp and box, with holes beside them.
  for (const int row : {-1, 200, 280}) {
    ImageScan::Settings s;
    s.row = row;
    const ImageScan scan(s, scene);
    ASSERT_GE(scan.patches().size(), 2u) << "a part before and one behind a gap";
    std::vector<bool> touched(640, false);
    for (const ScanPatch& patch : scan.patches())
      for (int u = patch.first_column; u <= patch.last_column; ++u) {
        touched[static_cast<std::size_t>(u)] = true;
        // 1 cm at the distance of the scene, at most 1.2 m, is more than 4 pixels.
        for (int v = scan.row() - 4; v <= scan.row() + 4; ++v)
          for (int x = u - 4; x <= u + 4; ++x)
            ASSERT_TRUE(cloud.point(pixel(x, v)).allFinite()) << x << " " << v;
      }
    // The depth that is followed is the median of a square of 2 cm, at most 9 pixels to each side.
    const auto deepest = [&](int u) {
      double z = 0;
      for (int v = scan.row() - 9; v <= scan.row() + 9; ++v)
        for (int x = std::max(0, u - 9); x <= std::min(639, u + 9); ++x)
          z = std::max(z, scene.true_depth().z_m[pixel(x, v)]);
      return z;
    };
    std::vector<double> behind;  // distance of the HIP behind the surface at its pixel
    for (double t = 0; t < scan.duration_s() + 0.001; t += 0.001) {
      const Vec3 hip = cloud.image->X_WC.inverse() * scan.at(t).position_W;
      ASSERT_NEAR(camera.fy * hip.y() / hip.z() + camera.cy, scan.row(), 1e-9) << "along the row";
      const auto u = static_cast<int>(std::lround(camera.fx * hip.x() / hip.z() + camera.cx));
      const double surface = scene.true_depth().z_m[pixel(u, scan.row())];
      behind.push_back(hip.z() - surface);
      // 2 mm: noise and quantisation of the median.
      ASSERT_LT(hip.z(), touched[static_cast<std::size_t>(u)] ? deepest(u) + s.depth_m + 0.002 : surface)
          << u;
    }
    EXPECT_NEAR(behind.front(), -s.clearance_m, 0.002);
    EXPECT_NEAR(behind.back(), -s.clearance_m, 0.002);
    EXPECT_GT(std::count_if(behind.begin(), behind.end(), [](double d) { return d > 0.008; }), 3000);
  }
}

TEST(ImageScan, FindsAnObjectOnTheTableAndObeysGivenColumns) {
  const CameraScene scene = made<CameraScene>();
  // The scan finds ramp or box, not the table, which fills most of the image and is nearer at its lower edge.
  const ImageScan automatic({}, scene);
  double highest = 0;
  for (double t = 0; t < automatic.duration_s(); t += 0.001) {
    const Vec3 hip = automatic.at(t).position_W;
    highest = std::max(highest, scene.surface_height(hip.x(), hip.z(), 0));
  }
  EXPECT_GT(highest, 0.03);

  ImageScan::Settings s;
  s.row = 240, s.first_column = 300, s.last_column = 340;
  const ImageScan given(s, scene);
  EXPECT_EQ(given.row(), 240);
  ASSERT_EQ(given.patches().size(), 1u);
  EXPECT_EQ(given.patches()[0].first_column, 300);
  EXPECT_EQ(given.patches()[0].last_column, 340);
}

TEST(ImageScan, RefusesWhatItCannotScan) {
  const FlatGrid unorganised = made<FlatGrid>();
  EXPECT_THROW(ImageScan({}, unorganised), InputError);
  const CameraScene scene = made<CameraScene>();
  ImageScan::Settings s;
  s.row = 480;
  EXPECT_THROW(ImageScan(s, scene), InputError);
  s.row = 0;  // border pixels are not supported on all sides
  EXPECT_THROW(ImageScan(s, scene), InputError);
  s.row = 240, s.first_column = 20, s.last_column = 10;
  EXPECT_NE(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::trajectory_test

namespace remote_touch::scripted_motions_test {
namespace {

const double kDegree = std::acos(-1.0) / 180;

Poses poses(std::vector<double> rows) {
  return Poses({std::move(rows)}, FlatGrid({}, NoiseKey{}, scenes::kernels()));
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
  // The rotation has a constant rate.
  const double first = device.at(0.3).orientation_W.angularDistance(device.at(0.31).orientation_W);
  const double later = device.at(0.7).orientation_W.angularDistance(device.at(0.71).orientation_W);
  EXPECT_NEAR(first, later, 1e-8);
}

TEST(Poses, RefuseWhatIsNotUnique) {
  EXPECT_EQ(validate(Poses::Settings{}), "");
  EXPECT_NE(validate(Poses::Settings{{}}), "");
  EXPECT_NE(validate(Poses::Settings{{0, 0, 0, 0, 0, 0, -1}}), "");
  const auto turned = [](double degrees, double duration) {
    return validate(Poses::Settings{{0, 0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 10 + degrees, 0, duration}});
  };
  EXPECT_EQ(turned(179, 1), "");
  EXPECT_NE(turned(180, 1), "");
  EXPECT_NE(turned(-180, 1), "");
  EXPECT_EQ(turned(180, 0), "") << "a jump goes no way";
  EXPECT_EQ(turned(360, 1), "");
}

RandomMotion motion_of(const RandomMotion::Settings& settings) {
  return RandomMotion(settings, FlatGrid({}, NoiseKey{}, scenes::kernels()));
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
  const double degree = std::acos(-1.0) / 180;
  EXPECT_LE(max_rotation, s.max_rotation_deg * degree * (1 + 1e-9));
  EXPECT_GT(max_rotation, 0.5 * s.max_rotation_deg * degree);
}

TEST(RandomMotion, EverySeedIsAnotherMotion) {
  RandomMotion::Settings s;
  const RandomMotion one = motion_of(s), same = motion_of(s);
  s.seed = 2;
  const RandomMotion other = motion_of(s);
  for (const double t : {3.0, 0.0, 7.7}) {
    EXPECT_EQ(one.at(t).position_W, same.at(t).position_W);
    EXPECT_GT((one.at(t).position_W - other.at(t).position_W).norm(), 1e-3);
    EXPECT_GT(one.at(t).orientation_W.angularDistance(other.at(t).orientation_W), 1e-2);
  }
  EXPECT_EQ(one.at(10).position_W, one.at(1e9).position_W);
  EXPECT_EQ(one.duration_s(), 10);
}

TEST(RandomMotion, RefusesABoxThatIsTooSmall) {
  RandomMotion::Settings s;
  EXPECT_EQ(validate(s), "");
  s.extent_m = {1e-7, 0, 0};
  EXPECT_NE(validate(s), "");
  s.extent_m.setZero();
  EXPECT_NE(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::scripted_motions_test
