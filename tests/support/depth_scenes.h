// Depth images with known surfaces: a camera's view of planes, spheres and steps, with noise and holes. They
// are test data only: the bits of noise need not be the same everywhere.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/points/point_cloud.h"

namespace remote_touch::scenes {

// The surface's normals point towards the camera, in its frame.
struct DepthScene {
  CameraIntrinsics camera;
  DepthImage depth;
  std::vector<Vec3> normals;
};

inline CameraIntrinsics kinect(int width = 640, int height = 480) {
  return {width, height, 525, 525, 0.5 * (width - 1), 0.5 * (height - 1)};
}

inline Vec3 ray(const CameraIntrinsics& camera, int u, int v) {
  return unproject(camera, u, v, 1);
}

// surface(ray) returns depth and normal. A depth that is NaN is a hole.
template <class Surface>
DepthScene seen(const CameraIntrinsics& camera, const Surface& surface) {
  DepthScene scene{camera, {camera.width, camera.height, {}}, {}};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const auto [z, normal] = surface(ray(camera, u, v));
      scene.depth.z_m.push_back(z);
      scene.normals.push_back(normal.dot(ray(camera, u, v)) > 0 ? Vec3(-normal) : Vec3(normal));
    }
  return scene;
}

// n . p = n . (0, 0, z_m)
inline DepthScene plane(const CameraIntrinsics& camera, const Vec3& direction, double z_m) {
  const Vec3 n = direction.normalized();
  return seen(camera, [=](const Vec3& r) { return std::pair(n.z() * z_m / n.dot(r), n); });
}

// A sphere without a background: the depth is NaN if a ray misses it.
inline DepthScene sphere(const CameraIntrinsics& camera, const Vec3& centre, double radius) {
  return seen(camera, [=](const Vec3& r) {
    const double b = r.dot(centre), root = b * b - r.squaredNorm() * (centre.squaredNorm() - radius * radius);
    const double z =
        root < 0 ? std::numeric_limits<double>::quiet_NaN() : (b - std::sqrt(root)) / r.squaredNorm();
    return std::pair(z, Vec3((z * r - centre) / radius));
  });
}

// A wall of waves, z = z_m + height cos(x k) cos(y k). Fixed-point steps find it, exact to rounding.
inline DepthScene waves(const CameraIntrinsics& camera, double z_m, double height, double length) {
  const double k = 2 * 3.14159265358979323846 / length;
  return seen(camera, [=](const Vec3& r) {
    double z = z_m;
    for (int step = 0; step < 60; ++step)
      z = z_m + height * std::cos(k * z * r.x()) * std::cos(k * z * r.y());
    const double x = k * z * r.x(), y = k * z * r.y();
    const double dx = -height * k * std::sin(x) * std::cos(y), dy = -height * k * std::cos(x) * std::sin(y);
    return std::pair(z, Vec3(-dx, -dy, 1).normalized());
  });
}

// Two walls that face the camera. The right one is `step` farther away.
inline DepthScene step(const CameraIntrinsics& camera, double z_m, double step_m) {
  return seen(camera,
              [=](const Vec3& r) { return std::pair(r.x() < 0 ? z_m : z_m + step_m, Vec3(0, 0, 1)); });
}

inline void add_noise(DepthImage& depth, double sigma_m, unsigned seed) {
  if (sigma_m == 0) return;  // the library's distribution needs a width
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, sigma_m);
  for (double& z : depth.z_m) z += normal(random);
}

// A share of the pixels are holes. Each has one of the values that mean no measurement.
inline void add_holes(DepthImage& depth, double fraction, unsigned seed, const std::vector<double>& values) {
  std::mt19937 random(seed);
  for (double& z : depth.z_m) {
    const bool hole = random() < fraction * 4294967296.0;
    const double value = values[random() % values.size()];
    if (hole) z = value;
  }
}

// The effect of a filter on a step: its largest depth error there without noise, and the share of the noise
// that remains on the walls. filtered(depth, camera) returns the depths of a cloud in the camera frame.
struct StepSmear {
  double max_error_m;
  double noise_gain;
};

template <class Filtered>
StepSmear smear_of_step(double z_m, double step_m, double sigma_m, const Filtered& filtered) {
  const DepthScene truth = step(kinect(160, 120), z_m, step_m);
  const std::vector<double> clean = filtered(truth.depth, truth.camera);
  DepthImage noisy = truth.depth;
  add_noise(noisy, sigma_m, 1);
  const std::vector<double> left = filtered(noisy, truth.camera);
  StepSmear smear{0, 0};
  double count = 0;
  for (int v = 10; v < 110; ++v)
    for (int u = 10; u < 150; ++u) {
      const std::size_t i = static_cast<std::size_t>(v * 160 + u);
      smear.max_error_m = std::max(smear.max_error_m, std::abs(clean[i] - truth.depth.z_m[i]));
      if (std::abs(u - 79.5) < 10) continue;
      smear.noise_gain += std::pow(left[i] - truth.depth.z_m[i], 2), ++count;
    }
  smear.noise_gain = std::sqrt(smear.noise_gain / count) / sigma_m;
  return smear;
}

}  // namespace remote_touch::scenes
