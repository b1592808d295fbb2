// The simple depth camera against closed forms, and the scenes that it sees: solids on a table, the beating
// heart, the tank of valves and its water.
#include "scenarios/simulated/camera_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/point_cloud.h"
#include "scenarios/simulated/depth_camera.h"
#include "tests/support/scenes.h"

namespace remote_touch::depth_camera_test {
namespace {

constexpr std::uint32_t kTable = 0x204060, kBlock = 0xC03020;
constexpr double kBlockTop_m = 0.1;

DepthCameraSettings small() {
  return {.width = 64,
          .height = 48,
          .focal_px = 60,
          .camera_position_m = {0, 0.5, 0},
          .noise_per_m = 0,
          .quantisation_per_m = 0};
}
DepthCamera made(const DepthCameraSettings& settings, std::uint64_t seed = 1) {
  return DepthCamera(settings, NoiseKey{seed}, scenes::kernels());
}
std::size_t pixel(int u, int v) {
  return static_cast<std::size_t>(v) * 64 + static_cast<std::size_t>(u);
}

RayHit table(const Vec3& origin, const Vec3& ray) {
  return ray.y() < 0 ? RayHit{-origin.y() / ray.y(), kTable} : RayHit{};
}
// A block on the table fills the half-space above 0 along the axis (0: x, 2: z), below its top.
RayCast table_and_block(int axis) {
  return [axis](const Vec3& origin, const Vec3& ray) {
    const RayHit top = {(kBlockTop_m - origin.y()) / ray.y(), kBlock};
    return origin[axis] + top.t * ray[axis] > 0 ? top : table(origin, ray);
  };
}

TEST(LookAt, AxesAreRightHandedAndTheWorldsUpIsUpInTheImage) {
  const PointCloud at = scenes::random_cloud(100, 1, 1);
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const RigidTransform X_WC = look_at(at.point(i), at.point(i + 1));
    EXPECT_LT((X_WC.linear().transpose() * X_WC.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(X_WC.linear().determinant(), 1, 1e-14);
    EXPECT_EQ(X_WC.translation(), at.point(i));
    const Vec3 target_C = X_WC.inverse() * at.point(i + 1);
    EXPECT_LT(target_C.head<2>().norm(), 1e-14);
    EXPECT_GT(target_C.z(), 0);
    EXPECT_NEAR(X_WC.linear()(1, 0), 0, 1e-16) << "image rows are level";
    EXPECT_LT(X_WC.linear()(1, 1), 0) << "image down goes down";
  }
}

TEST(LookAt, TheImagesRightIsXIfTheCameraLooksStraightDownOrUp) {
  const RigidTransform down = look_at({0.1, 0.5, 0.2}, {0.1, 0, 0.2}), up = look_at({0, 0, 0}, {0, 2, 0});
  EXPECT_EQ(down.linear().col(0), Vec3(1, 0, 0));
  EXPECT_EQ(down.linear().col(1), Vec3(0, 0, 1)) << "the image's up is -z";
  EXPECT_EQ(down.linear().col(2), Vec3(0, -1, 0));
  EXPECT_EQ(up.linear().col(0), Vec3(1, 0, 0));
  EXPECT_EQ(up.linear().col(1), Vec3(0, 0, -1));
  // A camera that has moved a little towards +z sees nearly the same image.
  EXPECT_LT((look_at({0.1, 0.5, 0.2 + 1e-6}, {0.1, 0, 0.2}).linear() - down.linear()).norm(), 1e-5);
}

TEST(DepthCamera, APlaneIsSeenAtItsDepth) {
  DepthCameraSettings s = small();
  s.camera_position_m = {0.4, 0.3, 0}, s.hole_px = 0;  // looks down at an angle whose sine is 3 / 5
  const DepthCamera slanting = made(s);
  const IdealView view = slanting.view(table, false);
  const PointCloud cloud = slanting.measured(view, 0);
  for (const int v : {0, 20, 47}) {
    const double down = (v - 23.5) / 60;
    EXPECT_NEAR(view.depth.z_m[pixel(5, v)], 0.3 / (0.6 + 0.8 * down), 1e-14) << v;
    EXPECT_NEAR(cloud.y[pixel(5, v)], 0, 1e-15);
  }
}

TEST(DepthCamera, ColumnsAreAlongXAndRowsAlongZSeenFromAbove) {
  const DepthCamera camera = made(small());
  const PointCloud cloud = camera.measured(camera.view(table, false), 0);
  ASSERT_TRUE(cloud.image.has_value());
  for (const int v : {0, 17, 47})
    for (const int u : {0, 31, 63}) {
      const Vec3 expected((u - 31.5) / 60 * 0.5, 0, (v - 23.5) / 60 * 0.5);
      EXPECT_LT((cloud.point(pixel(u, v)) - expected).norm(), 1e-15) << u << " " << v;
    }
}

TEST(DepthCamera, MeasuresNothingBeyondThreeMetres) {
  DepthCameraSettings s = small();
  s.camera_position_m = {0, 0.5, 0}, s.target_position_m = {1, 0.5, 0};
  const IdealView view = made(s).view(table, true);
  for (int v = 0; v < 48; ++v) {
    const double depth = 0.5 * 60 / (v - 23.5);
    EXPECT_EQ(std::isnan(view.depth.z_m[pixel(9, v)]), !(v > 23 && depth <= 3)) << v;
    EXPECT_EQ(view.colour[pixel(9, v)], v > 23 ? kTable : 0) << "the colour camera sees the far table too";
  }
}

TEST(DepthCamera, HolesAreOnlyNearEdgesAndKeepTheirColour) {
  for (const int axis : {0, 2})
    for (const int reach : {0, 1, 3}) {
      DepthCameraSettings s = small();
      s.hole_px = reach;
      const DepthCamera camera = made(s);
      const IdealView view = camera.view(table_and_block(axis), true);
      const PointCloud cloud = camera.measured(view, 0);
      // The block's edge meets the optical axis: it is between the middle columns or rows.
      for (int v = 0; v < 48; ++v)
        for (int u = 0; u < 64; ++u) {
          const std::size_t i = pixel(u, v);
          const int beyond = axis == 0 ? u - 32 : v - 24;
          EXPECT_EQ(view.hole[i] != 0, beyond >= -reach && beyond < reach) << reach << ": " << beyond;
          for (const double c : {cloud.x[i], cloud.y[i], cloud.z[i]})
            EXPECT_EQ(std::isnan(c), view.hole[i] != 0);
          EXPECT_EQ(cloud.colour[i], beyond < 0 ? kTable : kBlock);
        }
    }
  DepthCameraSettings blind = small();
  blind.edge_jump_m = kBlockTop_m + 1e-9;
  for (const char hole : made(blind).view(table_and_block(0), false).hole) EXPECT_EQ(hole, 0);
}

TEST(DepthCamera, DepthsAreWholeDisparities) {
  DepthCameraSettings s = small();
  s.camera_position_m = {0.4, 0.3, 0}, s.quantisation_per_m = 0.01;
  const DepthCamera camera = made(s);
  const IdealView view = camera.view(table, false);
  const PointCloud cloud = camera.measured(view, 0);
  const RigidTransform X_CW = camera.pose().inverse();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::isnan(cloud.x[i])) continue;
    const double z = (X_CW * cloud.point(i)).z(), level = 100 / z;
    EXPECT_NEAR(level, std::round(level), 1e-9);
    EXPECT_LE(std::abs(level - 100 / view.depth.z_m[i]), 0.5 + 1e-9) << "the nearest one";
  }
}

TEST(DepthCamera, ADepthWhoseDisparityIsRoundedToZeroIsLost) {
  DepthCameraSettings s = small();
  s.noise_per_m = 0, s.quantisation_per_m = 0.1;
  const DepthImage far{s.width, s.height,
                       std::vector<double>(static_cast<std::size_t>(s.width * s.height), 30)};
  for (const double z : made(s).measured_depth(made(s).view(far, {}), 0).z_m) EXPECT_TRUE(std::isnan(z));
}

TEST(DepthCamera, NoiseHasTheSetDeviationAndDependsOnTheFrame) {
  DepthCameraSettings s = small();
  s.noise_per_m = 0.01;
  for (const double z : {0.5, 1.0}) {
    s.camera_position_m = {0, z, 0};
    const DepthCamera camera = made(s), other = made(s, 2);
    const IdealView view = camera.view(table, false);
    double sum = 0, squares = 0, count = 0;
    for (int frame = 0; frame < 20; ++frame)
      for (const double y : camera.measured(view, frame).y) sum += y, squares += y * y, ++count;
    const double sigma = 0.01 * z * z;
    EXPECT_NEAR(sum / count, 0, 5 * sigma / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count), sigma, 5 * sigma / std::sqrt(2 * count));

    EXPECT_EQ(camera.measured(view, 7).y, camera.measured(view, 7).y);
    EXPECT_NE(camera.measured(view, 7).y, camera.measured(view, 8).y);
    EXPECT_NE(camera.measured(view, 7).y, other.measured(view, 7).y);
  }
}

TEST(CameraScene, NoiseFreePointsLieOnTheSurfaceInSight) {
  CameraScene::Settings s;
  s.camera.noise_per_m = s.camera.quantisation_per_m = 0;
  const CameraScene scene(s, NoiseKey{1}, scenes::kernels());
  const PointCloud cloud = scene.cloud(0);
  int on_solids = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    if (std::isnan(cloud.x[i])) continue;
    const Vec3 p = cloud.point(i);
    ASSERT_LT(std::abs(scene.signed_distance(p, 0)), 1e-12) << p.transpose();
    for (const double fraction : {0.7, 0.9, 0.99, 0.999})
      ASSERT_GT(scene.signed_distance(Vec3(0.3, 0.6, -0.02) + fraction * (p - Vec3(0.3, 0.6, -0.02)), 0), 0);
    on_solids += p.y() > 0.001;
  }
  EXPECT_GT(on_solids, 5000);
}

}  // namespace
}  // namespace remote_touch::depth_camera_test

namespace remote_touch::beating_heart_test {
namespace {

constexpr double kBeat_s = 0.8;  // period of 75 beats a minute

BeatingHeart made(const BeatingHeart::Settings& settings = {}) {
  return BeatingHeart(settings, NoiseKey{1}, scenes::kernels());
}
BeatingHeart ideal() {
  BeatingHeart::Settings s;
  s.camera.noise_per_m = 0, s.camera.quantisation_per_m = 0;
  return made(s);
}
double top(const BeatingHeart& heart, double time_s) {
  return heart.surface_height(0, 0, time_s);
}

// Positions on and around the organ.
std::vector<Vec3> places() {
  const PointCloud at = scenes::random_cloud(300, 1, 3);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < at.size(); ++i)
    places.emplace_back(0.08 * at.x[i], 0.03 + 0.05 * at.y[i], 0.06 * at.z[i]);
  return places;
}

TEST(BeatingHeart, EveryBeatIsTheSame) {
  for (const double rate : {75.0, 40.0}) {
    BeatingHeart::Settings s;
    s.rate_per_min = rate;
    const BeatingHeart heart = made(s);
    bool moves = false;
    for (const Vec3& p : places())
      for (const double t : {0.0, 0.11, 0.37, 0.6}) {
        const double now = heart.signed_distance(p, t);
        EXPECT_NEAR(heart.signed_distance(p, t + 60 / rate), now, 1e-15);
        EXPECT_NEAR(heart.signed_distance(p, t + 1000 * 60 / rate), now, 1e-13);
        moves |= std::abs(heart.signed_distance(p, t + 30 / rate) - now) > 0.001;
      }
    EXPECT_TRUE(moves) << "a period of half a beat";
  }
}

// The speed is computed by differences over h. Its largest values are those of a fifth-order step. It changes
// no faster than by the largest acceleration of such a step, 10 / sqrt(3) amplitude / duration^2.
TEST(BeatingHeart, TheTopSinksByTheAmplitudeAndMovesSmoothly) {
  const BeatingHeart heart = made();
  EXPECT_NEAR(top(heart, 0), 0.06, 1e-15);
  EXPECT_NEAR(top(heart, 0.32 * kBeat_s), 0.06 - 0.0065, 1e-15) << "it stays contracted for a moment";
  const double h = 1e-4, contraction_s = 0.3 * kBeat_s, relaxation_s = 0.4 * kBeat_s;
  const auto speed = [&](double t) { return (top(heart, t + h) - top(heart, t - h)) / (2 * h); };
  double max_speed_down = 0, max_speed_up = 0;
  for (double t = -0.1; t < 2 * kBeat_s; t += h) {
    max_speed_down = std::max(max_speed_down, -speed(t)), max_speed_up = std::max(max_speed_up, speed(t));
    const double acceleration = 10 / std::sqrt(3.0) * 0.0065 / (contraction_s * contraction_s);
    ASSERT_LE(std::abs(speed(t + h) - speed(t)), 1.001 * h * acceleration) << t;
  }
  EXPECT_NEAR(max_speed_down, 15.0 / 8 * 0.0065 / contraction_s, 1e-5);
  EXPECT_NEAR(max_speed_up, 15.0 / 8 * 0.0065 / relaxation_s, 1e-5);
}

TEST(BeatingHeart, TheSurfaceIsWhereTheDistanceIsZero) {
  const BeatingHeart heart = made();
  for (const Vec3& p : places())
    for (const double t : {0.0, 0.1, 0.24, 0.5}) {
      const Vec3 on(p.x(), heart.surface_height(p.x(), p.z(), t), p.z());
      EXPECT_NEAR(heart.signed_distance(on, t), 0, 1e-13);
      if (heart.signed_distance(p, t) < 0) {
        EXPECT_LT(p.y(), on.y()) << "inside is below the top";
      }
    }
  EXPECT_NEAR(heart.signed_distance({0, 0.07, 0}, 0), 0.01, 1e-15);
  EXPECT_NEAR(heart.signed_distance({0.3, 0.07, 0}, 0), 0.07, 1e-15) << "over the table";
  EXPECT_NEAR(heart.signed_distance({0.3, -0.02, 0}, 0), -0.02, 1e-15) << "in the table";
}

TEST(BeatingHeart, IdealPointsLieOnTheSurfaceOfTheirTime) {
  const BeatingHeart heart = ideal();
  for (const int frame : {0, 2, 5, 7, 1000}) {
    const PointCloud cloud = heart.cloud(frame);
    const double time = heart.captured_s(frame);
    int on_organ = 0, holes = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const bool hole = std::isnan(cloud.x[i]), organ = cloud.colour[i] != 0x3A6E78;
      on_organ += organ, holes += hole;
      if (hole || (!organ && i % 7 != 0)) continue;  // a sample is enough for the table
      const Vec3 p = cloud.point(i);
      ASSERT_LT(std::abs(heart.signed_distance(p, time)), 1e-9) << p.transpose();
      ASSERT_EQ(organ, p.y() > 1e-9) << "colour and place agree";
    }
    EXPECT_GT(on_organ, 4000);
    EXPECT_LT(holes, 4000);
  }
}

TEST(BeatingHeart, RestsAtZeroAmplitude) {
  BeatingHeart::Settings s;
  EXPECT_EQ(made().frame_count(), std::numeric_limits<int>::max());
  s.amplitude_m = 0;
  EXPECT_GT(made(s).frame_count(), 1) << "its noise does not";
  s.camera.noise_per_m = 0;
  const BeatingHeart heart = made(s);
  EXPECT_EQ(heart.frame_count(), 1);
  for (const Vec3& p : places())
    EXPECT_EQ(heart.signed_distance(p, 0.3), heart.signed_distance(p, 0)) << p.transpose();
  EXPECT_TRUE(scenes::same_clouds(heart.cloud(0), heart.cloud(9)));
}

}  // namespace
}  // namespace remote_touch::beating_heart_test

namespace remote_touch::valve_tank_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Settings = ValveTank::Settings;

ValveTank made(const Settings& settings = {}, std::uint64_t seed = 1) {
  return ValveTank(settings, NoiseKey{seed}, scenes::kernels());
}
Settings ideal() {
  Settings s;
  s.turbidity_per_m = 0, s.colour_noise = 0, s.dropout_probability = 0;
  s.camera.noise_per_m = 0, s.camera.quantisation_per_m = 0;
  return s;
}
TEST(ValveTank, HasOneFrameIfThereIsNoNoise) {
  EXPECT_EQ(made(ideal()).frame_count(), 1);
  for (double Settings::*varies :
       {&Settings::turbidity_per_m, &Settings::colour_noise, &Settings::dropout_probability}) {
    Settings s = ideal();
    s.*varies = 0.1;
    EXPECT_EQ(made(s).frame_count(), std::numeric_limits<int>::max());
  }
}

TEST(ValveTank, IdealPointsLieOnWhatTheirClassSays) {
  const ValveTank tank = made(ideal());
  const PointCloud cloud = tank.cloud(0);
  const std::vector<Valve> truth = tank.truth();
  ASSERT_EQ(truth.size(), cloud.size());
  int points[3] = {};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p = cloud.point(i);
    ++points[static_cast<std::size_t>(truth[i])];
    const double distance = truth[i] == Valve::none ? p.z() : tank.distance_to_valve(truth[i], p);
    ASSERT_NEAR(distance, 0, 2e-9) << p.transpose();
    ASSERT_NEAR(tank.signed_distance(p, 0), 0, 2e-9) << p.transpose();
    EXPECT_EQ(p.x() < 0, truth[i] == Valve::left || (truth[i] == Valve::none && p.x() < 0));
  }
  EXPECT_GT(points[1], 500);
  EXPECT_GT(points[2], 500);
  EXPECT_GT(points[0], 200000);
}

TEST(ValveTank, DistancesAreOfWallAndValves) {
  const ValveTank tank = made();
  EXPECT_NEAR(tank.signed_distance({0, 0.2, 0.03}, 0), 0.03, 1e-15);
  EXPECT_NEAR(tank.signed_distance({0, 0.2, -0.03}, 0), -0.03, 1e-15) << "in the wall";
  EXPECT_NEAR(tank.signed_distance({0.11, 0, 0.09}, 0), 0.02, 1e-15);
  EXPECT_NEAR(tank.distance_to_valve(Valve::left, {-0.11, 0.062, 0.06}), 0.01, 1e-15);
  EXPECT_NEAR(tank.distance_to_valve(Valve::right, {-0.11 - 0.052 - 0.22, 0, 0.06}), 0.44, 1e-15);
}

TEST(ValveTank, PixelsWithoutDepthKeepTheirColour) {
  Settings all = ideal();
  all.dropout_probability = 1;
  const PointCloud blind = made(all).cloud(0);
  for (std::size_t i = 0; i < blind.size(); ++i) ASSERT_FALSE(blind.is_measured(i));
  EXPECT_EQ(blind.colour, made(ideal()).cloud(0).colour);
}

TEST(ValveTank, ColourNoiseHasItsDeviation) {
  Settings s = ideal();
  const std::vector<std::uint32_t> still = made(s).cloud(0).colour;
  s.colour_noise = 6;
  const std::vector<std::uint32_t> noisy = made(s).cloud(0).colour;
  EXPECT_NE(noisy, made(s).cloud(1).colour);
  EXPECT_NE(noisy, made(s, 2).cloud(0).colour);
  for (const int shift : {16, 8, 0}) {
    double sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < still.size(); ++i) {
      const double value = still[i] >> shift & 0xFF;
      if (value < 40 || value > 215) continue;  // cut off at 0 and 255
      const double off = (noisy[i] >> shift & 0xFF) - value;
      sum += off, squares += off * off, ++count;
    }
    EXPECT_NEAR(sum / count, 0, 0.1);
    EXPECT_NEAR(std::sqrt(squares / count), std::sqrt(36 + 1.0 / 12), 0.1);  // rounding adds 1 / 12
  }
}

// A fixture by colour must work at the defaults: both rules find their valve and little else.
TEST(ValveTank, HueFindsTheValves) {
  const ValveTank tank = made();
  const PointCloud cloud = tank.cloud(0);
  const std::vector<Valve> truth = tank.truth();
  for (const Valve valve : {Valve::left, Valve::right}) {
    HueRange::Settings s;
    if (valve == Valve::right) s.from_deg = 40, s.to_deg = 70;
    const std::vector<double> weights = HueRange(s).weights(cloud);
    double found = 0, right = 0, there = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      found += weights[i], right += truth[i] == valve ? weights[i] : 0;
      there += truth[i] == valve && cloud.is_measured(i);
    }
    EXPECT_GT(right, 0.9 * there);
    EXPECT_GT(right, 0.9 * found);
  }
}

TEST(Water, DecayIsTheExponential) {
  EXPECT_EQ(decay(0), 1);
  for (double x = 1e-12; x < 64; x = 1.01 * x + 1e-6) {
    EXPECT_NEAR(decay(x) / std::exp(-x), 1, 1e-12) << x;
    EXPECT_LE(decay(1.001 * x + 1e-9), decay(x)) << x;
  }
  EXPECT_EQ(decay(64), 0);
  EXPECT_EQ(decay(kInfinity), 0);
}

// Each channel of a colour decays by itself towards the veil; depths are lost and get noisy.
TEST(Water, ChangesWhatIsSeenByItsFormulas) {
  for (const double turbidity : {0.0, 0.5, 0.8, 1000.0})
    for (const double distance : {0.0, 0.5, 2.0, 100.0, kInfinity}) {
      const Water water(turbidity);
      const double depth = turbidity == 0 ? 0 : turbidity * std::min(distance, 1e6);
      for (const std::uint32_t rgb : {0x000000u, 0xFFFFFFu, 0x12AB00u}) {
        const std::array<double, 3> seen = water.seen(rgb, distance);
        for (std::size_t i = 0; i < 3; ++i) {
          const double own = rgb >> (16 - 8 * i) & 0xFF, through = std::exp(-Water::kAttenuation[i] * depth);
          EXPECT_NEAR(seen[i], own * through + Water::kVeil[i] * (1 - through), 1e-9) << depth;
        }
      }
      for (const double lost : {0.0, 0.02, 1.0})
        EXPECT_NEAR(water.lost(lost, distance), 1 - (1 - lost) * std::exp(-0.25 * depth), 1e-12);
      EXPECT_NEAR(water.depth_noise_factor(distance), 1 + depth, 1e-15 * (1 + depth));
    }
  EXPECT_EQ(Water(0).seen(0x12AB00, kInfinity), (std::array<double, 3>{0x12, 0xAB, 0})) << "clear";
  EXPECT_LT(Water(0.5).seen(0xFFFFFF, 2)[0], Water(0.5).seen(0xFFFFFF, 2)[2]) << "red is lost first";
}

}  // namespace
}  // namespace remote_touch::valve_tank_test
