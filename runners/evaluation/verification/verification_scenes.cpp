#include "runners/evaluation/verification/verification_scenes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/camera.h"
#include "runners/evaluation/verification/scene_parts.h"
#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

namespace {

Vec3 roof(double u, double v) {
  return {u, -1.5 * std::abs(u), v};
}

MetamorphicScene bumpy_slide(const Kernels& kernels) {
  return resting_scene(
      "bumpy-slide", "bumps at rest, pressed and slid over",
      {{0, {-0.02, 0.009, -0.01}}, {30, {-0.02, -0.009, -0.01}}, {320, {0.021, -0.012, 0.012}}},
      sheet(bumpy_surface, kJitter_m, 1, 0, kernels), {kSlightTilt, {0.05, 0.02, -0.03}});
}

MetamorphicScene held(const Kernels& kernels) {
  return held_scene("held", "bumps at rest, pressed and then held still",
                    {{0, {0.003, 0.009, 0.004}}, {20, {0.003, -0.009, 0.004}}},
                    sheet(bumpy_surface, kJitter_m, 2, 0, kernels), {kSteepTilt, {-0.02, 0.04, 0.01}});
}

MetamorphicScene touch_and_go(const Kernels& kernels) {
  return resting_scene("touch-and-go", "a rough plane at rest, entered, slid over and left",
                       {{0, {-0.015, 0.012, 0.01}},
                        {40, {-0.015, -0.007, 0.01}},
                        {250, {0.02, -0.01, -0.012}},
                        {290, {0.021, 0.015, -0.012}},
                        {320, {0.021, 0.016, -0.012}}},
                       sheet(flat_surface, 0.001, 3, 0, kernels), {kSlightTilt, {0.01, -0.06, 0.02}});
}

MetamorphicScene ridge(const Kernels& kernels) {
  return resting_scene(
      "ridge", "a sharp ridge at rest, slid across",
      {{0, {-0.02, 0, 0.006}}, {30, {-0.016, -0.037, 0.004}}, {320, {0.018, -0.036, -0.008}}},
      sheet(roof, kJitter_m, 4, 0, kernels), {kSteepTilt, {0.03, 0.01, 0.04}});
}

MetamorphicScene corner(const Kernels& kernels) {
  return resting_scene("corner", "two walls that meet, pressed into and slid along",
                       {{0, {0.012, 0.02, -0.01}},
                        {30, {0.009, -0.008, -0.008}},
                        {120, {-0.002, -0.008, -0.003}},
                        {320, {-0.002, -0.008, 0.01}}},
                       sheet(groove_surface, kJitter_m, 5, 0, kernels), {kSteepTilt, {-0.04, 0.02, -0.01}});
}

// Chapter 5: points that are balls and have their own stiffness.
MetamorphicScene regions(const Kernels& kernels) {
  PointCloud cloud = sheet(flat_surface, kJitter_m, 6, 0, kernels);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.fixture_radius_m.push_back(std::max(0.0, 0.002 * wave(cloud.x[i] / 0.04)));
    cloud.stiffness_N_per_m.push_back(500 + 300 * wave(cloud.z[i] / 0.02));
  }
  return resting_scene(
      "regions", "a plane at rest with forbidden regions and stiffness of its points, slid over",
      {{0, {-0.022, 0.012, 0.01}}, {30, {-0.02, -0.006, 0.01}}, {320, {0.02, -0.008, -0.012}}}, cloud,
      {kSlightTilt, {-0.03, 0.05, 0.02}});
}

MetamorphicScene rise(const Kernels& kernels) {
  return rising_scene(
      "rise", "a noisy plane that rises faster and faster, pressed",
      {{0, {-0.01, 0.009, 0.005}}, {30, {-0.01, -0.012, 0.005}}, {320, {0.008, -0.014, -0.004}}},
      [](double time_s) { return 0.05 * time_s + 0.1 * time_s * time_s; },
      [&](int view, const SceneSurface& surface) { return sheet(surface, 0.0005, 7, view, kernels); },
      {kSlightTilt, {0.02, -0.03, 0.05}});
}

// Chapter 5 in motion: overlapping forbidden regions of different radii rise against the HIP.
MetamorphicScene rising_regions(const Kernels& kernels) {
  return rising_scene(
      "rising-regions", "forbidden regions around a noisy plane that rises, pressed",
      {{0, {-0.01, 0.02, 0.005}}, {30, {-0.01, 0.001, 0.005}}, {320, {0.008, -0.001, -0.004}}},
      [](double time_s) { return 0.04 * time_s + 0.08 * time_s * time_s; },
      [&](int view, const SceneSurface& surface) {
        PointCloud cloud = sheet(surface, 0.0003, 9, view, kernels);
        for (std::size_t i = 0; i < cloud.size(); ++i)
          cloud.fixture_radius_m.push_back(0.008 + 0.001 * wave(cloud.x[i] / 0.05));
        return cloud;
      },
      {kSteepTilt, {-0.01, 0.02, 0.03}});
}

// Depth along the optical axis of a table that falls away to the left.
double table_depth_m(double u, double v) {
  return 0.45 - 0.0004 * u + 0.0007 * v;
}

// Depth image of the table with a block on it, and with pixels that measured nothing (NaN).
DepthImage depth_image(int view, const CameraIntrinsics& camera, const Kernels& kernels) {
  constexpr double kBlock_m = 0.012, kNoise_m = 0.0003;
  PointCloud noise;
  for (int i = 0; i < camera.width * camera.height; ++i) noise.append(Vec3::Zero());
  add_noise(noise, kNoise_m, noise_stream(NoiseKey{8}, NoiseUse::depth, static_cast<std::uint32_t>(view)),
            kernels);
  DepthImage depth{camera.width, camera.height, {}};
  for (int i = 0; i < camera.width * camera.height; ++i) {
    const int u = i % camera.width, v = i / camera.width;
    const bool hole = (7 * u + 13 * v) % 61 == 0, block = u > 48 && v > 20;
    const double true_m = table_depth_m(u, v) - (block ? kBlock_m : 0);
    depth.z_m.push_back(hole ? std::numeric_limits<double>::quiet_NaN()
                             : true_m + noise.z[static_cast<std::size_t>(i)]);
  }
  return depth;
}

MetamorphicScene camera(const Kernels& kernels) {
  const CameraIntrinsics intrinsics{96, 72, 300, 300, 47.3, 35.8};
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear() = kSteepTilt.normalized().toRotationMatrix();
  X_WC.translation() = Vec3(0.1, 0.3, -0.2);
  const auto behind = [&](double u, double v, double depth_m) {
    return unproject(intrinsics, u, v, table_depth_m(u, v) + depth_m);
  };
  MetamorphicScene scene =
      scene_of("camera", "an organised cloud of a table and a block on it, slid over",
               {{0, behind(25, 30, -0.01)},
                {30, behind(25, 31, 0.008)},
                {160, behind(43, 34, 0.007)},
                {180, behind(52, 36, -0.02)},  // over the edge
                {200, behind(54, 37, -0.005)},
                {320, behind(66, 40, -0.004)}},
               [&](int view, double) {
                 return cloud_from_depth(depth_image(view, intrinsics, kernels), intrinsics, X_WC);
               });
  for (Vec3& hip : scene.hip_W) hip = X_WC * hip;
  return scene;
}

}  // namespace

std::vector<MetamorphicScene> verification_scenes(const Kernels& kernels) {
  return {bumpy_slide(kernels), rise(kernels),   touch_and_go(kernels),   ridge(kernels), corner(kernels),
          regions(kernels),     camera(kernels), rising_regions(kernels), held(kernels)};
}

}  // namespace remote_touch
