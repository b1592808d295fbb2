// The depth pipeline compared with the equations in double precision, on synthetic scenes, every window size
// and recorded frames; its bits, holes and odd frames, and sharp edges.
#include "core/dissertation/depth/depth_pipeline.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "runners/evaluation/contract/allocation_counter.h"
#include "scenarios/recordings/recording.h"
#include "tests/core/dissertation/depth/depth_cases.h"
#include "tests/core/dissertation/depth/reference_depth_pipeline.h"
#include "tests/support/recorded_data.h"

namespace remote_touch::depth_pipeline_test {
namespace {

using namespace depth_cases;

struct Deviation {
  double max_deg = 0, rms_deg = 0;
  double max_fraction = 0;  // largest error of a point, as a fraction of its distance from the camera
  std::size_t normals = 0, undecided = 0;
};

// Limits for a decidable normal. Single precision cannot decide it if two eigenvalues are nearly equal or if
// the points lie nearly on a line. Nor can it decide which side of a plane faces the camera if the plane is
// seen edge-on, as from one pixel column.
constexpr double kClearGap = 2e-3, kClearWidth = 1e-3, kClearSide = 1e-4, kClearLine = 1e-6;

bool undecided(const ReferenceDepth& reference, std::size_t i, const Vec3& p_C) {
  const Vec3 normal = reference.cloud.image->X_WC.linear().transpose() * reference.cloud.normal(i);
  return reference.gap[i] < kClearGap || reference.middle[i] < kClearWidth ||
         std::abs(normal.dot(p_C)) < kClearSide * p_C.norm();
}

Deviation deviation(const PointCloud& cloud, const ReferenceDepth& reference) {
  Deviation d;
  const RigidTransform X_CW = reference.cloud.image->X_WC.inverse();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool there = !std::isnan(reference.cloud.x[i]);
    EXPECT_EQ(!std::isnan(cloud.x[i]), there) << i;
    if (!there) {
      EXPECT_FALSE(has_normal(cloud, i)) << i;
      continue;
    }
    const Vec3 p_C = X_CW * reference.cloud.point(i);
    const double off_m = (cloud.point(i) - reference.cloud.point(i)).norm();
    d.max_fraction = std::max(d.max_fraction, off_m / p_C.norm());
    if (!(reference.middle[i] > kClearLine)) {  // NaN for a single point
      EXPECT_FALSE(has_normal(cloud, i)) << i;
      continue;
    }
    if (undecided(reference, i, p_C)) {
      ++d.undecided;
      continue;
    }
    EXPECT_TRUE(has_normal(cloud, i)) << i;
    EXPECT_NEAR(cloud.normal(i).norm(), 1, 1e-12) << i;
    double angle = kInfinity;
    for (const Vec3& normal : reference.as_good[i])
      angle = std::min(angle, angle_deg(cloud.normal(i), normal));
    d.max_deg = std::max(d.max_deg, angle), d.rms_deg += angle * angle, ++d.normals;
  }
  d.rms_deg = d.normals ? std::sqrt(d.rms_deg / static_cast<double>(d.normals)) : 0;
  return d;
}

// The limit for normals is 0.05 degrees. The error of a filtered depth is 8e-6 (the error of the weights)
// times the differences to its neighbours.
void expect_as_reference(const std::string& what, const scenes::DepthScene& scene, const Settings& settings,
                         double max_undecided = 0) {
  const RigidTransform X_WC = some_pose();
  const ReferenceDepth reference = reference_depth_pipeline(settings, scene.depth, scene.camera, X_WC);
  const PointCloud cloud = processed(scene, settings, X_WC);
  EXPECT_TRUE(cloud.image->X_WC.isApprox(X_WC));
  const Deviation d = deviation(cloud, reference);
  EXPECT_LE(d.max_deg, 0.05) << what;
  EXPECT_LE(d.rms_deg, 0.001) << what;
  EXPECT_LE(d.max_fraction, 2e-6) << what;
  EXPECT_LE(static_cast<double>(d.undecided), max_undecided * static_cast<double>(d.normals)) << what;
  printf("%s: %zu normals, largest %.5f deg, rms %.6f deg, points %.2g, undecided %zu\n", what.c_str(),
         d.normals, d.max_deg, d.rms_deg, d.max_fraction, d.undecided);
}

TEST(DepthPipeline, AgreesWithTheEquations) {
  for (const bool filter : {true, false}) {
    Settings settings;
    settings.filter = filter;
    const std::string suffix = filter ? ", filtered" : ", not filtered";
    expect_as_reference("waves" + suffix, noisy_waves(160, 120), settings);
    expect_as_reference("waves with holes" + suffix, with_holes(noisy_waves(160, 120)), settings, 1e-3);
    expect_as_reference("step" + suffix, scenes::step(scenes::kinect(160, 120), 0.8, 0.025), settings);
    expect_as_reference("sphere" + suffix, scenes::sphere(scenes::kinect(160, 120), {0.02, 0, 0.6}, 0.05),
                        settings);
  }
}

TEST(DepthPipeline, AgreesWithTheEquationsForEveryWindow) {
  for (int window = 3; window <= 15; window += 2)
    expect_as_reference("window " + std::to_string(window), with_holes(noisy_waves(70, 50), 0.1),
                        {true, window, 0.01, 18 - window, 0.008}, 0.02);
}

TEST(DepthPipeline, AgreesWithTheEquationsForEveryStepAndFit) {
  for (const auto& [window, step] : {std::pair{3, 1}, {5, 2}, {9, 1}, {9, 2}, {9, 4}, {13, 3}, {15, 7}})
    for (const NormalFit fit : {NormalFit::total_least_squares, NormalFit::inverse_depth})
      expect_as_reference("normals " + std::to_string(window) + " by " + std::to_string(step) +
                              (fit == NormalFit::inverse_depth ? ", inverse depth" : ""),
                          with_holes(noisy_waves(70, 50), 0.1), {true, 5, 0.01, window, 0.02, step, fit},
                          0.02);
  for (const auto& scene :
       {scenes::step(scenes::kinect(160, 120), 0.8, 0.025),
        scenes::sphere(scenes::kinect(160, 120), {0.02, 0, 0.6}, 0.05), with_holes(noisy_waves(160, 120))})
    expect_as_reference("fast", scene, kFastDepthPipeline, 0.02);
}

// Returns the middle of a recorded frame: half of its width and height, because the reference is slow.
scenes::DepthScene middle_of(const std::filesystem::path& recording) {
  const PointCloud cloud = read_frame(index_recording(recording), 0, kInfinity);
  CameraIntrinsics camera = cloud.image->camera;
  const int whole_width = camera.width, left = camera.width / 4, top = camera.height / 4;
  camera.width /= 2, camera.height /= 2, camera.cx -= left, camera.cy -= top;
  scenes::DepthScene scene{camera, {camera.width, camera.height, {}}, {}};
  for (int row = 0; row < camera.height; ++row) {
    const auto first = cloud.z.begin() + (top + row) * whole_width + left;
    scene.depth.z_m.insert(scene.depth.z_m.end(), first, first + camera.width);
  }
  return scene;
}

TEST(DepthPipeline, AgreesWithTheEquationsOnRecordedFrames) {
  for (const char* name : {"visp_organ_table", "sr305_hand_flex", "pcd_single/mosd_boxes_learn3.pcd"}) {
    const std::filesystem::path path = data_root() / "rgbd" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "recorded data are missing: " << path;
    const scenes::DepthScene scene = middle_of(path);
    expect_as_reference(name, scene, {}, 0.015);
    expect_as_reference(std::string(name) + ", fast", scene, kFastDepthPipeline, 0.015);
    expect_as_reference(std::string(name) + ", sigma_f 0.01", scene, {true, 9, 0.01, 9, 0.014}, 0.01);
  }
}

// --- bits, holes, odd frames, and simple scenes with known normals ---

TEST(DepthPipeline, HasTheSameBitsOnEveryLevelAndForAnyNumberOfThreads) {
  const scenes::DepthScene scene = with_holes(noisy_waves(333, 250), 0.05);
  for (const Settings& settings :
       {Settings{}, Settings{true, 5, 0.02, 11, 0.01}, Settings{false, 9, 0.02, 9, 0.014},
        Settings{true, 3, 0.02, 9, 0.014, 2}, Settings{true, 7, 0.02, 13, 0.02, 3}, kFastDepthPipeline,
        Settings{true, 5, 0.02, 13, 0.02, 3, NormalFit::inverse_depth},
        Settings{false, 3, 0.02, 15, 0.02, 1, NormalFit::inverse_depth, true}}) {
    const PointCloud expected = processed(scene, settings);
    for (const Kernels* kernels : supported_kernels())
      for (const int threads : {1, 2, 5}) {
        omp_set_num_threads(threads);
        DepthPipeline pipeline(settings, *kernels);
        EXPECT_TRUE(same_bits(pipeline.process(scene.depth, scene.camera, kIdentity), expected))
            << kernels->isa << ", threads: " << threads;
      }
  }
  omp_set_num_threads(omp_get_num_procs());
}

TEST(DepthPipeline, ARectangleHasTheBitsOfTheWholeFrame) {
  scenes::DepthScene scene = with_holes(noisy_waves(200, 150), 0.05);
  // The memory behind the image holds rows that continue its surface. They must not change the result.
  const std::size_t pixels = scene.depth.z_m.size();
  scene.depth.z_m.reserve(2 * pixels);
  for (std::size_t i = 0; i < pixels; ++i) scene.depth.z_m.push_back(scene.depth.z_m[pixels - 200 + i % 200]);
  scene.depth.z_m.resize(pixels);
  const RigidTransform X_WC = some_pose();
  for (const Settings& settings : {Settings{}, Settings{true, 5, 0.02, 13, 0.02, 3}, kFastDepthPipeline,
                                   Settings{true, 15, 0.02, 15, 0.02, 1, NormalFit::inverse_depth, true}}) {
    DepthPipeline pipeline(settings, best());
    const PointCloud whole = pipeline.process(scene.depth, scene.camera, X_WC);
    PointCloud part;
    for (const PixelRectangle& at :
         {PixelRectangle{70, 50, 50, 50}, PixelRectangle{0, 0, 9, 150}, PixelRectangle{3, 2, 1, 1},
          PixelRectangle{150, 140, 50, 10}, PixelRectangle{0, 0, 200, 150}, PixelRectangle{10, 10, 0, 5}}) {
      pipeline.process(scene.depth, scene.camera, X_WC, at, part);
      ASSERT_EQ(part.size(), static_cast<std::size_t>(at.width * at.height));
      PointCloud expected;
      for (int v = at.top; v < at.top + at.height; ++v)
        for (int u = at.left; u < at.left + at.width; ++u) {
          const std::size_t i = static_cast<std::size_t>(v * 200 + u);
          expected.append(whole.point(i), whole.normal(i));
        }
      EXPECT_TRUE(same_bits(part, expected)) << at.left << " " << at.top;
      ASSERT_TRUE(part.image);
      const CameraIntrinsics& own = part.image->camera;
      EXPECT_EQ(own.width * own.height, at.width * at.height);
      EXPECT_EQ(unproject(own, 0, 0, 1).x(), unproject(scene.camera, at.left, at.top, 1).x());
    }
  }
}

TEST(DepthPipeline, HolesAreNoPointsAndDoNotMatter) {
  scenes::DepthScene scene = noisy_waves(160, 120);
  scenes::add_holes(scene.depth, 0.3, 5, {kNaN});
  DepthPipeline pipeline({}, best());
  const PointCloud expected = pipeline.process(scene.depth, scene.camera, kIdentity);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool there = !std::isnan(scene.depth.z_m[i]);
    ASSERT_EQ(pipeline.valid()[i], there ? 1 : 0) << i;
    ASSERT_EQ(std::isnan(expected.x[i]) || std::isnan(expected.y[i]) || std::isnan(expected.z[i]), !there)
        << i;
    ASSERT_EQ(has_normal(expected, i), there) << i;  // so many neighbours always make a plane
  }
  for (const double value : kNoDepth) {
    scenes::DepthScene other = noisy_waves(160, 120);
    scenes::add_holes(other.depth, 0.3, 5, {value});
    EXPECT_TRUE(same_bits(pipeline.process(other.depth, other.camera, kIdentity), expected)) << value;
  }
}

TEST(DepthPipeline, HandlesEmptyAndTinyFrames) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 5}, {3, 3}, {40, 30}, {0, 0}}) {
    scenes::DepthScene scene = scenes::plane(scenes::kinect(width, height), {0.1, 0.2, 1}, 0.8);
    const PointCloud cloud = processed(scene);
    ASSERT_EQ(cloud.size(), static_cast<std::size_t>(width * height));
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_FALSE(std::isnan(cloud.x[i]));
      EXPECT_EQ(has_normal(cloud, i), width > 2)
          << width << " x " << height;  // else the points are on a line
    }
    for (double& z : scene.depth.z_m) z = kNaN;
    DepthPipeline pipeline({}, best());
    const PointCloud none = pipeline.process(scene.depth, scene.camera, kIdentity);
    for (std::size_t i = 0; i < none.size(); ++i) {
      EXPECT_TRUE(std::isnan(none.x[i]) && std::isnan(none.nx[i]));
      EXPECT_EQ(pipeline.valid()[i], 0);
    }
  }
}

// Rows, columns and diagonals of single points, as at the rim of what a camera sees.
TEST(DepthPipeline, PointsOnALineHaveNoNormal) {
  const scenes::DepthScene full = scenes::plane(scenes::kinect(80, 60), {0.3, 0.2, 1}, 0.8);
  for (const auto& [du, dv] : {std::pair{1, 0}, {0, 1}, {1, 1}, {2, 1}}) {
    scenes::DepthScene scene = full;
    for (int v = 0; v < 60; ++v)
      for (int u = 0; u < 80; ++u)
        if ((u - 40) * dv != (v - 30) * du) scene.depth.z_m[static_cast<std::size_t>(v * 80 + u)] = kNaN;
    for (Settings settings : {Settings{}, kFastDepthPipeline}) {
      settings.filter = false;  // a filter would bend the line
      const PointCloud cloud = processed(scene, settings);
      std::size_t points = 0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        points += !std::isnan(cloud.x[i]);
        EXPECT_FALSE(has_normal(cloud, i)) << i;
      }
      EXPECT_GT(points, 25u);
    }
  }
}

TEST(DepthPipeline, FindsTheNormalsOfAPlane) {
  const scenes::DepthScene plane = scenes::plane(scenes::kinect(160, 120), {0.4, -0.7, 1}, 0.7);
  for (Settings settings : {Settings{}, kFastDepthPipeline}) {
    settings.filter = false;
    const PointCloud flat = processed(plane, settings);
    for (std::size_t i = 0; i < flat.size(); ++i)
      ASSERT_LE(angle_deg(flat.normal(i), plane.normals[i]), 0.01) << i;
  }
}

TEST(DepthPipeline, KeepsMeasuredPointsIfTheFilterIsOff) {
  const scenes::DepthScene scene = with_holes(noisy_waves(80, 60));
  Settings settings;
  settings.filter = false;
  const PointCloud cloud = processed(scene, settings);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    ASSERT_TRUE(std::isnan(cloud.x[i]) || cloud.z[i] == scene.depth.z_m[i]) << i;
}

TEST(DepthPipeline, ACloudKeepsItsOtherColumns) {
  scenes::DepthScene scene = noisy_waves(120, 90);
  scenes::add_holes(scene.depth, 0.1, 5, {kNaN});
  const RigidTransform X_WC = some_pose();
  PointCloud cloud = cloud_from_depth(scene.depth, scene.camera, X_WC);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.colour.push_back(static_cast<std::uint32_t>(i));
    cloud.fixture_radius_m.push_back(1e-6 * static_cast<double>(i));
  }
  for (const bool filter : {true, false}) {
    Settings settings;
    settings.filter = filter;
    const PointCloud expected = processed(scene, settings, X_WC);
    PointCloud got = cloud;
    DepthPipeline(settings, best()).process(got);
    EXPECT_EQ(got.colour, cloud.colour);
    EXPECT_EQ(got.fixture_radius_m, cloud.fixture_radius_m);
    EXPECT_TRUE(filter ||
                (same_bits(got.x, cloud.x) && same_bits(got.y, cloud.y) && same_bits(got.z, cloud.z)));
    for (std::size_t i = 0; i < got.size(); ++i) {
      ASSERT_EQ(std::isnan(got.x[i]), std::isnan(expected.x[i])) << i;
      if (std::isnan(got.x[i])) continue;
      ASSERT_LE((got.point(i) - expected.point(i)).norm(), 1e-7) << i;  // depths differ by a rounding
      ASSERT_LE(angle_deg(got.normal(i), expected.normal(i)), 1e-3) << i;
    }
  }
}

// Compares the dissertation's sigma_f of 0.025 m with 0.01 m, on a step of 25 mm at 0.8 m with 1.5 mm of
// noise.
TEST(DepthPipeline, ANarrowFilterKeepsAStepAndTakesAwayAsMuchNoise) {
  const auto with = [](double sigma_f_m) {
    Settings settings;
    settings.sigma_f_m = sigma_f_m;
    return scenes::smear_of_step(0.8, 0.025, 0.0015,
                                 [&](const DepthImage& depth, const CameraIntrinsics& camera) {
                                   return DepthPipeline(settings, best()).process(depth, camera, kIdentity).z;
                                 });
  };
  const scenes::StepSmear wide = with(0.025), narrow = with(0.010);
  printf("sigma_f 0.025 m: largest error %.2f mm, noise x %.3f; 0.010 m: %.2f mm, x %.3f\n",
         1e3 * wide.max_error_m, wide.noise_gain, 1e3 * narrow.max_error_m, narrow.noise_gain);
  EXPECT_NEAR(wide.max_error_m, 0.008, 0.0005);
  EXPECT_NEAR(narrow.max_error_m, 0.0008, 0.0002);
  EXPECT_NEAR(narrow.noise_gain / wide.noise_gain, 1, 0.15);
  EXPECT_LT(wide.noise_gain, 0.13);  // 81 equal weights would give 1/9
}

TEST(DepthPipeline, AllocatesNothingAfterTheFirstFrame) {
  const scenes::DepthScene scene = noisy_waves(160, 120);
  omp_set_num_threads(1);  // other threads would allocate memory of their own
  DepthPipeline pipeline({}, best());
  PointCloud cloud, organised = cloud_from_depth(scene.depth, scene.camera, kIdentity);
  pipeline.process(scene.depth, scene.camera, kIdentity, cloud);
  pipeline.process(organised);
  const std::size_t before = allocation_count();
  pipeline.process(scene.depth, scene.camera, kIdentity, cloud);
  pipeline.process(organised);
  EXPECT_EQ(allocation_count(), before);
  pipeline.process(scene.depth, scene.camera, kIdentity);
  EXPECT_GT(allocation_count(), before);  // the counter counts
  omp_set_num_threads(omp_get_num_procs());
}

TEST(DepthPipeline, RefusesWhatDoesNotFit) {
  Settings window, normals, step, sharp;
  window.filter_window = 8, normals.normal_window = 10, step.normal_step = 3, sharp.sharp_edges = true;
  const std::pair<Settings, const char*> cases[] = {
      {window, "filter_window = 8: expected odd numbers, 3 to 15"},
      {normals, "normal_window = 10: expected odd numbers, 3 to 15"},
      {step, "normal_step = 3: expected a divisor of 4 = (normal_window - 1) / 2"},
      {sharp, "sharp_edges = true: expected normal_fit = inverse-depth"}};
  for (const auto& [settings, why] : cases) {
    EXPECT_EQ(validate(settings), why);
    EXPECT_THROW(DepthPipeline(settings, best()), std::invalid_argument) << why;
  }
  EXPECT_EQ(validate(kFastDepthPipeline) + validate(Settings{}), "");

  const scenes::DepthScene scene = scenes::plane(scenes::kinect(20, 10), {0, 0, 1}, 0.8);
  DepthPipeline pipeline({}, best());
  PointCloud cloud;
  EXPECT_THROW(pipeline.process(scene.depth, scenes::kinect(10, 20), kIdentity), std::invalid_argument);
  EXPECT_THROW(pipeline.process(cloud), std::invalid_argument);
  for (const PixelRectangle& at : {PixelRectangle{-1, 0, 5, 5}, {0, 6, 5, 5}, {16, 0, 5, 5}, {0, 0, -1, 5}})
    EXPECT_THROW(pipeline.process(scene.depth, scene.camera, kIdentity, at, cloud), std::invalid_argument);
}

// --- sharp_edges: normals are right up to a crease and up to a limb ---

Settings blunt() {
  Settings settings = kFastDepthPipeline;
  settings.sharp_edges = false;
  return settings;
}

// Two planes that fall away from the camera by 45 degrees on both sides of a ridge in the middle column.
scenes::DepthScene roof() {
  return scenes::seen(scenes::kinect(161, 120), [](const Vec3& ray) {
    const Vec3 normal = Vec3(ray.x() < 0 ? -1 : 1, 0, -1).normalized();
    return std::pair{0.8 / (1 - std::abs(ray.x())), normal};
  });
}

double rms_deg(const PointCloud& cloud, const scenes::DepthScene& truth, int margin, int from_middle,
               int to_middle) {
  double sum = 0, count = 0;
  const int width = truth.camera.width, height = truth.camera.height;
  for (int v = margin; v < height - margin; ++v)
    for (int u = margin; u < width - margin; ++u) {
      const auto i = static_cast<std::size_t>(v * width + u);
      const int away = std::abs(u - width / 2);
      if (away < from_middle || away > to_middle || std::isnan(truth.normals[i].x())) continue;
      const double angle = angle_deg(cloud.normal(i), truth.normals[i]);
      sum += angle * angle, ++count;
    }
  EXPECT_GT(count, 100);
  return std::sqrt(sum / count);
}

TEST(SharpEdges, NormalsAreRightUpToACrease) {
  const scenes::DepthScene truth = roof();
  const PointCloud rounded = processed(truth, blunt()), sharp = processed(truth, kFastDepthPipeline);
  for (int away = 2; away <= 5; ++away) {
    EXPECT_LT(rms_deg(sharp, truth, 12, away, away), 0.05) << away;
    if (away <= 3) {
      EXPECT_GT(rms_deg(rounded, truth, 12, away, away), 5) << away;
    }
  }
  scenes::DepthScene noisy = truth;
  scenes::add_noise(noisy.depth, 0.001, 3);
  const double before = rms_deg(processed(noisy, blunt()), truth, 12, 1, 5),
               after = rms_deg(processed(noisy, kFastDepthPipeline), truth, 12, 1, 5);
  printf("within 5 pixels of a ridge, 1 mm of noise: %.1f deg, sharp %.1f deg\n", before, after);
  EXPECT_LT(after, 0.5 * before);
}

// Noise seldom makes one window's error a quarter of another's, and neither does a curvature. Radius 0: a
// plane.
TEST(SharpEdges, APlaneAndABallInNoiseStayAsTheyAre) {
  for (const double radius_m : {0.0, 0.03, 0.06, 0.1}) {
    const bool is_ball = radius_m > 0;
    double max_ratio = 0;
    for (const double sigma_m : {0.0, 0.0005, 0.001, 0.002}) {
      scenes::DepthScene scene =
          is_ball ? scenes::sphere(scenes::kinect(160, 120), {0, 0, 0.7 + radius_m}, radius_m)
                  : scenes::plane(scenes::kinect(160, 120), {0.4, -0.7, 1}, 0.7);
      scenes::add_noise(scene.depth, sigma_m, 4);
      for (Vec3& normal : scene.normals)
        if (is_ball && normal.z() > -0.7) normal.setConstant(kNaN);  // seen at a grazing angle
      const double before = rms_deg(processed(scene, blunt()), scene, 12, 0, 80);
      const double after = rms_deg(processed(scene, kFastDepthPipeline), scene, 12, 0, 80);
      max_ratio = std::max(max_ratio, after / before);
    }
    printf("radius %g m: error of normals with sharp edges at most %.2f times as large\n", radius_m,
           max_ratio);
    EXPECT_LE(max_ratio, is_ball ? 1.2 : 1.02);
  }
}

// A step of 15 mm, which a window of 20 mm averages.
TEST(SharpEdges, NormalsAreRightUpToALimb) {
  const scenes::DepthScene truth = scenes::step(scenes::kinect(160, 120), 0.8, 0.015);
  const PointCloud rounded = processed(truth, blunt()), sharp = processed(truth, kFastDepthPipeline);
  EXPECT_GT(rms_deg(rounded, truth, 12, 3, 4), 10);
  EXPECT_LT(rms_deg(sharp, truth, 12, 3, 5), 0.05);
}

// A pixel without a plane of its own receives no normal from a plane beside it.
TEST(SharpEdges, AHoleAndALineOfPointsStayWithoutANormal) {
  scenes::DepthScene scene = roof();
  for (int v = 0; v < 120; ++v)
    for (int u = 30; u < 60; ++u)
      if (u != 45) scene.depth.z_m[static_cast<std::size_t>(v * 161 + u)] = kNaN;
  Settings settings = kFastDepthPipeline;
  settings.normal_radius_m = 0.01;  // the window ends within the gap
  const PointCloud cloud = processed(scene, settings);
  for (int v = 0; v < 120; ++v)
    for (int u = 30; u < 60; ++u) EXPECT_FALSE(has_normal(cloud, static_cast<std::size_t>(v * 161 + u))) << u;
}

}  // namespace
}  // namespace remote_touch::depth_pipeline_test
