// The depth pipeline compared with the equations in double precision: synthetic scenes, every window size,
// and recorded frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "scenarios/recordings/recording.h"
#include "tests/core/dissertation/depth/depth_cases.h"
#include "tests/core/dissertation/depth/reference_depth_pipeline.h"
#include "tests/support/recorded_data.h"

namespace remote_touch::depth_agreement_test {
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
  const Deviation d = deviation(processed(scene, settings, X_WC), reference);
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

scenes::DepthScene recorded(const std::filesystem::path& path) {
  const PointCloud cloud = read_frame(index_recording(path), 0, kInfinity);
  const CameraIntrinsics& camera = cloud.image->camera;
  return {camera, {camera.width, camera.height, cloud.z}, {}};
}

TEST(DepthPipeline, AgreesWithTheEquationsOnRecordedFrames) {
  for (const char* name : {"visp_organ_table", "sr305_hand_flex", "pcd_single/mosd_boxes_learn3.pcd"}) {
    const std::filesystem::path path = data_root() / "rgbd" / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "recorded data are missing: " << path;
    expect_as_reference(name, recorded(path), {}, 0.015);
    expect_as_reference(std::string(name) + ", fast", recorded(path), kFastDepthPipeline, 0.015);
    expect_as_reference(std::string(name) + ", sigma_f 0.01", recorded(path), {true, 9, 0.01, 9, 0.014},
                        0.01);
  }
}

}  // namespace
}  // namespace remote_touch::depth_agreement_test
