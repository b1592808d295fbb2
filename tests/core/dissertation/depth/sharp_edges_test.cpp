// sharp_edges: normals are right up to a crease and up to a limb. A surface without an edge keeps its
// normals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/core/dissertation/depth/depth_cases.h"

namespace remote_touch::sharp_edges_test {
namespace {

using namespace depth_cases;

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
}

TEST(SharpEdges, NormalsAreRightUpToACreaseInNoise) {
  scenes::DepthScene scene = roof();
  scenes::add_noise(scene.depth, 0.001, 3);
  const PointCloud rounded = processed(scene, blunt()), sharp = processed(scene, kFastDepthPipeline);
  const double before = rms_deg(rounded, scene, 12, 1, 5), after = rms_deg(sharp, scene, 12, 1, 5);
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
}  // namespace remote_touch::sharp_edges_test
