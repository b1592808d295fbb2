// Each fault of a sensor that concerns points, and its noise along the rays, against their definitions.
#include "scenarios/simulated/sensor_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/sensor_fault_scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sensor_faults_test {
namespace {

// Products of pairs over many frames: mean, and its standard deviation.
struct Correlation {
  double sum = 0, squares = 0, count = 0;
  void add(double product) { sum += product, squares += product * product, ++count; }
  void expect(double expected, const char* what) const {
    const double mean = sum / count, sd = std::sqrt((squares / count - mean * mean) / count);
    EXPECT_NEAR(mean, expected, 5 * sd) << what;
  }
};

PointCloud two_places(double x, double z, double dx, double dz) {
  PointCloud places;
  places.append({x, 0, z}), places.append({x + dx, 0, z + dz});
  return places;
}

// Returns the correlation of the noise at x and x + dx (in pitches), from the weights of the nodes around
// both.
double expected_correlation(double x, double dx) {
  const auto weight = [](double at, int node) { return std::max(0.0, 1 - std::abs(at - node)); };
  double product = 0, a = 0, b = 0;
  for (int node = -4; node <= 4; ++node) {
    product += weight(x, node) * weight(x + dx, node);
    a += weight(x, node) * weight(x, node), b += weight(x + dx, node) * weight(x + dx, node);
  }
  return product / std::sqrt(a * b);
}

TEST(RayNoise, IsCorrelatedAcrossTheViewAsItsLatticeSays) {
  constexpr double kPitch_m = 0.01;
  for (const double dx : {0.0, 0.3, 1.0, 1.6, 2.1}) {
    Correlation square, along_x, along_z;
    for (int frame = 0; frame < 4000; ++frame) {
      const std::vector<double> n = standard_noise(
          {0.01, kPitch_m, 0}, two_places(0.003, -0.007, kPitch_m * dx, 0), kKey, frame, scenes::kernels());
      const std::vector<double> m = standard_noise(
          {0.01, kPitch_m, 0}, two_places(-0.007, 0.003, 0, kPitch_m * dx), kKey, frame, scenes::kernels());
      square.add(n[1] * n[1]), along_x.add(n[0] * n[1]), along_z.add(m[0] * m[1]);
    }
    square.expect(1, "variance");
    along_x.expect(expected_correlation(0.3, dx), "x");
    along_z.expect(expected_correlation(0.3, dx), "z");
  }
}

// The correlation of two frames is m^lag over many rays, from the first frame on. Without a correlation
// across the view the rays are independent, even at one place.
TEST(RayNoise, TheCorrelationOfFramesIsThePowerOfTheMemory) {
  PointCloud places;
  for (int i = 0; i < 20000; ++i) places.append({0, 0, 0});
  for (const double memory : {0.0, 0.3, 0.9, 0.99}) {
    std::vector<std::vector<double>> frames;
    for (int frame = 0; frame <= 70; ++frame)
      frames.push_back(standard_noise({0.01, 0, memory}, places, kKey, frame, scenes::kernels()));
    for (const auto& [first, lag] :
         {std::pair{0, 0}, {0, 1}, {9, 1}, {10, 0}, {31, 1}, {31, 2}, {40, 0}, {0, 10}, {15, 20}, {5, 64}}) {
      const std::vector<double>&a = frames[static_cast<std::size_t>(first)],
            &b = frames[static_cast<std::size_t>(first + lag)];
      Correlation product, of_neighbours;
      for (std::size_t i = 0; i < places.size(); ++i) product.add(a[i] * b[i]);
      for (std::size_t i = 1; i < places.size(); ++i) of_neighbours.add(a[i] * b[i - 1]);
      product.expect(std::pow(memory, lag), "memory to the power of the lag");
      of_neighbours.expect(0, "between points");
    }
  }
}

TEST(RayNoise, APositionHasTheSameNoiseInEveryCloud) {
  PointCloud alone, many = scenes::random_cloud(100, 0.3, 4);
  alone.append({0.0123, 0, -0.0456});
  many.append(alone.point(0));
  many.append(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  const RayNoise noise{0.01, 0.005, 0.3};
  const std::vector<double> a = standard_noise(noise, alone, kKey, 7, scenes::kernels());
  const std::vector<double> b = standard_noise(noise, many, kKey, 7, scenes::kernels());
  EXPECT_EQ(a[0], b[100]);
  EXPECT_TRUE(std::isnan(b[101]));
}

// A lattice of 39 million nodes is refused, one of a million is not.
TEST(RayNoise, RefusesALatticeThatIsTooFineForTheCloud) {
  const auto noise = [](double pitch_m) {
    return standard_noise({0.01, pitch_m, 0}, two_places(0, 0, 0.1, 0.1), kKey, 0, scenes::kernels());
  };
  const std::string text = refusal([&] { noise(1.6e-5); });
  EXPECT_HAS(text, "faults.ray_noise_correlation_m: needs a lattice of ");
  EXPECT_HAS(text, ": expected a larger value, for at most 16777216 nodes, or 0");
  EXPECT_HAS(refusal([&] { noise(1e-7); }), "for at most 16777216 nodes") << "beyond the range of numbers";
  EXPECT_EQ(noise(1e-4).size(), 2u);
}

TEST(SensorFaults, RayNoiseGrowsWithTheSquareOfTheDistanceAlongTheRays) {
  SensorFaults s;
  s.ray_noise.sigma_m = 0.002, s.view_direction = {0, -3, 0}, s.sensor_distance_m = 2;
  const auto clean = bare();
  const FaultySensor sensor = faulty(s);
  Correlation square;
  for (const int frame : {0, 20, 39}) {
    const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
    for (std::size_t i = 0; i < after.size(); ++i) {
      ASSERT_TRUE(after.x[i] == before.x[i] && after.z[i] == before.z[i]);
      const double distance = 2 - before.y[i];
      const double noise = (after.y[i] - before.y[i]) / (0.002 * distance * distance);
      square.add(noise * noise);
    }
  }
  square.expect(1, "variance in units of sigma distance^2");
  EXPECT_EQ(sensor.frame_count(), std::numeric_limits<int>::max()) << "noise goes on on a surface at rest";
}

TEST(SensorFaults, RayNoiseOfAnImageIsAlongTheRayOfEachPixel) {
  SensorFaults s;
  s.ray_noise.sigma_m = 0.002;
  const PointCloud before = camera()->cloud(0), after = faulty(s, camera()).cloud(0);
  const Vec3 eye = before.image->X_WC.translation();
  Correlation square;
  for (std::size_t i = 0; i < after.size(); i += 7) {
    if (!before.is_measured(i)) continue;
    const Vec3 ray = before.point(i) - eye, displacement = after.point(i) - before.point(i);
    ASSERT_LT(displacement.cross(ray).norm(), 1e-14);
    const double noise = displacement.dot(ray.normalized()) / (0.002 * ray.squaredNorm());
    square.add(noise * noise);
  }
  square.expect(1, "variance in units of sigma distance^2");
}

TEST(SensorFaults, AllOffGiveTheScenarioBitForBit) {
  MovingShape::Settings noisy = rising_plane();
  noisy.noise_sigma_m = 0.001;
  SensorFaults off;
  off.view_direction = {0.3, -0.7, 0.1};
  const FaultySensor same = faulty(off, bare(noisy)), seen = faulty(off, camera());
  const auto plane = bare(noisy), scene = camera();
  EXPECT_EQ(same.frame_count(), plane->frame_count());
  EXPECT_EQ(seen.frame_count(), scene->frame_count());
  for (const int frame : {0, 1, 17, 40}) {
    EXPECT_TRUE(same_points(same.cloud(frame), plane->cloud(frame)));
    EXPECT_TRUE(same_points(seen.cloud(frame), scene->cloud(frame)));
    EXPECT_EQ(same.captured_s(frame), plane->captured_s(frame));
    EXPECT_FALSE(same.delivery(frame).leaves_sensor_s);
    const auto same_points = same.points(frame), plane_points = plane->points(frame);
    const auto &same_type = *same_points, &plane_type = *plane_points;
    EXPECT_TRUE(typeid(same_type) == typeid(plane_type));
  }
}

// A recording that was cut short, seen by a sensor far away.
class Recorded final : public Scenario {
 public:
  double frame_rate_hz() const override { return 30; }
  int frame_count() const override { return 1; }
  std::vector<Phase> phases() const override { return {{"the lift", 1, 2}}; }
  std::string input() const override { return "one frame"; }
  std::vector<Note> input_notes() const override { return {{"cut short", "it ends early"}}; }
  std::optional<RigidTransform> sensor_pose() const override {
    return RigidTransform(Eigen::Translation3d(0, 5, 0));
  }
  std::shared_ptr<const NeighbourSearch> points(int) const override { return make_search({}); }
  PointCloud cloud(int) const override { return {}; }
  double signed_distance(const Vec3&, double) const override { return 0; }
  std::vector<PosedMesh> true_meshes(double) const override { return {{"a cube", {}, {}, {}}}; }
};

TEST(SensorFaults, KeepWhatTheScenarioReports) {
  const FaultySensor sensor = faulty({}, std::make_unique<Recorded>());
  ASSERT_EQ(sensor.phases().size(), 1u);
  EXPECT_EQ(sensor.phases()[0].name, "the lift");
  EXPECT_EQ(sensor.input(), "one frame");
  ASSERT_EQ(sensor.input_notes().size(), 1u);
  EXPECT_EQ(sensor.input_notes()[0].kind, "cut short");
  EXPECT_EQ(sensor.sensor_pose().value().translation().y(), 5);
  ASSERT_EQ(sensor.true_meshes(0).size(), 1u);
  EXPECT_EQ(sensor.true_meshes(0)[0].name, "a cube");
  MovingShape::Settings tilted;
  tilted.motion.tilt_deg = 20;
  SensorFaults holes;
  holes.hole_fraction = 0.3;
  const FaultySensor poor = faulty(holes, bare(tilted));
  EXPECT_EQ(poor.plane_normal(0.2), bare(tilted)->plane_normal(0.2));
  EXPECT_EQ(poor.true_normal({0, 0.01, 0}, 0.2), bare(tilted)->true_normal({0, 0.01, 0}, 0.2));
}

TEST(SensorFaults, QuantisedPlacesAreTheNearestMultiplesAlongTheView) {
  SensorFaults s;
  s.quantisation_m = 0.003, s.view_direction = {1, -2, 2};
  const Vec3 view_direction = s.view_direction / 3;
  MovingShape::Settings rough = rising_plane();
  rough.noise_sigma_m = 0.004;
  const auto clean = bare(rough);
  const FaultySensor sensor = faulty(s, bare(rough));
  for (const int frame : {0, 9}) {
    const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double steps = after.point(i).dot(view_direction) / 0.003;
      ASSERT_NEAR(steps, std::round(steps), 1e-10);
      const Vec3 displacement = after.point(i) - before.point(i);
      ASSERT_LE(displacement.norm(), 0.0015 + 1e-15);
      ASSERT_LT((displacement - displacement.dot(view_direction) * view_direction).norm(), 1e-15);
    }
  }
}

// The displacement is uniform: its mean is 0, and its standard deviation is the half width divided by
// sqrt(3). An outlier does not fly, too: those that move by no more than a flying point are not counted.
TEST(SensorFaults, FlyingPointsAndOutliersMoveAlongTheView) {
  SensorFaults fly, outliers;
  fly.flying_probability = 0.2, fly.max_flying_distance_m = 0.03, fly.view_direction = {0, 0, 5};
  outliers = fly, outliers.flying_probability = 1, outliers.max_flying_distance_m = 0.001;
  outliers.outlier_probability = 0.1, outliers.max_outlier_distance_m = 0.2;
  for (const auto& [faults, probability, least_m, reach_m] :
       {std::tuple(fly, 0.2, 0.0, 0.03), std::tuple(outliers, 0.1, 0.001, 0.2)}) {
    const auto clean = bare();
    const FaultySensor sensor = faulty(faults);
    double moved = 0, all = 0, sum = 0, squares = 0;
    for (int frame = 0; frame < 20; ++frame) {
      const PointCloud before = clean->cloud(frame), after = sensor.cloud(frame);
      for (std::size_t i = 0; i < after.size(); ++i) {
        ++all;
        const double displacement = after.z[i] - before.z[i];
        ASSERT_TRUE(after.x[i] == before.x[i] && after.y[i] == before.y[i]);
        ASSERT_LE(std::abs(displacement), reach_m + 1e-15);
        if (std::abs(displacement) > least_m + 1e-15)
          ++moved, sum += displacement, squares += displacement * displacement;
      }
    }
    expect_fraction(moved / (1 - least_m / reach_m), all, probability);
    const double sd = reach_m / std::sqrt(3.0);
    EXPECT_NEAR(sum / moved, 0, 5 * sd / std::sqrt(moved));
    EXPECT_NEAR(std::sqrt(squares / moved), sd, 5 * sd / std::sqrt(moved));
  }
}

// Points in an image stay on their rays, so that the search by pixels finds them.
TEST(SensorFaults, PointsOfAnImageMoveAlongTheirRays) {
  SensorFaults s;
  s.flying_probability = 0.3, s.max_flying_distance_m = 0.05, s.quantisation_m = 0.01;
  const FaultySensor sensor = faulty(s, camera());
  const PointCloud before = camera()->cloud(0), after = sensor.cloud(0);
  ASSERT_TRUE(after.image);
  const RigidTransform X_CW = after.image->X_WC.inverse();
  double moved = 0, all = 0;
  for (std::size_t i = 0; i < after.size(); i += 7) {
    ASSERT_EQ(before.is_measured(i), after.is_measured(i));
    if (!after.is_measured(i)) continue;
    const Vec3 p_C = X_CW * after.point(i), q_C = X_CW * before.point(i);
    const double steps = p_C.z() / 0.01;
    ASSERT_NEAR(steps, std::round(steps), 1e-10) << "the depth of an image is rounded, not the distance";
    ASSERT_LT((p_C / p_C.z() - q_C / q_C.z()).norm(), 1e-14);
    ++all, moved += std::abs(p_C.z() - q_C.z()) > 0.005 + 1e-12 ? 1 : 0;
  }
  EXPECT_GT(moved / all, 0.25);
  const auto points = sensor.points(0);
  for (std::size_t i = 100000; i < after.size(); i += 9973) {
    if (!after.is_measured(i)) continue;
    const Ball ball{after.point(i), 0.02};
    EXPECT_EQ(scenes::gathered(*points, ball).size(), scenes::gathered(BruteForceSearch(after), ball).size());
  }
}

TEST(SensorFaults, PointsBehindTheCameraAreLost) {
  SensorFaults s;
  s.outlier_probability = 1, s.max_outlier_distance_m = 5;
  const PointCloud before = camera()->cloud(0), after = faulty(s, camera()).cloud(0);
  const RigidTransform X_CW = after.image->X_WC.inverse();
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after.is_measured(i)) {
      ASSERT_GT((X_CW * after.point(i)).z(), 0);
    }
  // About half of the points are lost: they move by up to 5 m in either direction, from about 0.6 m away.
  EXPECT_NEAR(static_cast<double>(measured(after)) / static_cast<double>(measured(before)), 0.56, 0.05);
}

TEST(SensorFaults, DropoutLosesItsSharePointByPoint) {
  SensorFaults s;
  s.dropout_probability = 0.3;
  const FaultySensor sensor = faulty(s);
  double lost = 0, all = 0, twice = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const PointCloud before = bare()->cloud(frame), after = sensor.cloud(frame);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      ++all;
      if (after.is_measured(i)) {
        ASSERT_EQ(after.point(i), before.point(i));
        continue;
      }
      ASSERT_TRUE(std::isnan(after.x[i]) && std::isnan(after.y[i]) && std::isnan(after.z[i]));
      ++lost, twice += i > 0 && !after.is_measured(i - 1) ? 1 : 0;
    }
  }
  expect_fraction(lost, all, 0.3);
  expect_fraction(twice, lost, 0.3);  // independent of the previous point
}

// Checks that a point is missing if and only if it lies within the radius of some middle around which all
// points are missing.
void expect_round_holes(const PointCloud& before, const PointCloud& after, const Vec3& view_direction,
                        double radius_m) {
  const auto apart = [&](std::size_t i, std::size_t j) {
    const Vec3 displacement = before.point(i) - before.point(j);
    return (displacement - displacement.dot(view_direction) * view_direction).norm();
  };
  std::vector<bool> explained(before.size());
  for (std::size_t middle = 0; middle < before.size(); ++middle) {
    std::vector<std::size_t> inside;
    bool whole = true;
    for (std::size_t i = 0; whole && i < before.size(); ++i) {
      if (apart(i, middle) > radius_m) continue;
      whole = !after.is_measured(i);
      inside.push_back(i);
    }
    for (const std::size_t i : inside) explained[i] = explained[i] || whole;
  }
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(explained[i], !after.is_measured(i)) << i;
}

TEST(SensorFaults, HolesAreRoundAndTakeAboutTheirShare) {
  for (const Vec3& view_direction : {Vec3(0, -1, 0), Vec3(0.6, -0.8, 0)}) {
    SensorFaults s;
    s.hole_fraction = 0.25, s.hole_radius_m = 0.007, s.view_direction = view_direction;
    const FaultySensor sensor = faulty(s);
    std::vector<PointCloud> frames;
    for (const int frame : {0, 1, 2}) {
      const PointCloud before = bare()->cloud(frame);
      frames.push_back(sensor.cloud(frame));
      const double lost = 3000 - static_cast<double>(measured(frames.back()));
      EXPECT_GE(lost, 750);
      EXPECT_LE(lost, 750 + 3.2 * 0.007 * 0.007 / (0.002 * 0.002) * 1.7);  // the last hole, seen aslant
      expect_round_holes(before, frames.back(), view_direction, 0.007);
    }
    EXPECT_FALSE(scenes::same_bits(frames[0].x, frames[1].x)) << "elsewhere in each frame";
  }
}

TEST(SensorFaults, HolesInAnImageAreRoundInTheImage) {
  SensorFaults s;
  s.hole_fraction = 0.05, s.hole_radius_m = 0.02;
  const PointCloud before = camera()->cloud(0), after = faulty(s, camera()).cloud(0);
  const CameraIntrinsics& eye = after.image->camera;
  const double all = static_cast<double>(measured(before));
  const double lost = all - static_cast<double>(measured(after));
  EXPECT_GE(lost, 0.05 * all);
  // The largest hole is that of the nearest point, about 0.45 m away.
  EXPECT_LE(lost, 0.05 * all + 3.2 * std::pow(0.02 / 0.45 * eye.fx, 2));
  // Lost points are contiguous along the rows: there are few borders for so many points.
  double borders = 0;
  for (std::size_t i = 1; i < after.size(); ++i)
    borders +=
        before.is_measured(i) && before.is_measured(i - 1) && after.is_measured(i) != after.is_measured(i - 1)
            ? 1
            : 0;
  EXPECT_LT(borders, 0.15 * lost);
}

TEST(SensorFaults, AllPointsCanBeLost) {
  SensorFaults holes, drops;
  holes.hole_fraction = 1, drops.dropout_probability = 1;
  EXPECT_EQ(measured(faulty(holes).cloud(3)), 0u);
  EXPECT_EQ(measured(faulty(drops).cloud(3)), 0u);
  EXPECT_EQ(faulty(drops).points(3)->size(), 3000u);
}

TEST(SensorFaults, LostPointsLoseTheirNormals) {
  SensorFaults drops;
  drops.dropout_probability = 0.5;
  const PointCloud cloud =
      faulty(drops, std::make_unique<MovingPlane>(MovingPlane::Settings{}, kKey, scenes::kernels())).cloud(0);
  ASSERT_TRUE(cloud.has_normals());
  for (std::size_t i = 0; i < cloud.size(); ++i) ASSERT_EQ(cloud.normal(i).allFinite(), cloud.is_measured(i));
}

}  // namespace
}  // namespace remote_touch::sensor_faults_test
