// Shared helpers for the tests of the depth pipeline.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"
#include "tests/support/depth_scenes.h"

namespace remote_touch::depth_cases {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kDegree = 3.14159265358979323846 / 180;
inline const RigidTransform kIdentity = RigidTransform::Identity();
inline const std::vector<double> kNoDepth = {kNaN,      0.0,        -0.0,  -1.0,
                                             kInfinity, -kInfinity, 1e300, kMaxDepth_m};

using Settings = DepthPipelineSettings;

inline const Kernels& best() {
  return kernels_for(best_isa());
}

inline RigidTransform some_pose() {
  return RigidTransform(Eigen::Translation3d(0.3, -1.2, 0.7) *
                        Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()));
}

inline PointCloud processed(const scenes::DepthScene& scene, const Settings& settings = {},
                            const RigidTransform& X_WC = kIdentity) {
  return DepthPipeline(settings, best()).process(scene.depth, scene.camera, X_WC);
}

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

inline bool same_bits(const PointCloud& a, const PointCloud& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z) && same_bits(a.nx, b.nx) &&
         same_bits(a.ny, b.ny) && same_bits(a.nz, b.nz);
}

inline bool has_normal(const PointCloud& cloud, std::size_t i) {
  return !std::isnan(cloud.nx[i]);
}

// The arctangent is accurate for small angles too. The arccosine is not.
inline double angle_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

inline scenes::DepthScene noisy_waves(int width, int height, double sigma_m = 0.0015) {
  scenes::DepthScene scene = scenes::waves(scenes::kinect(width, height), 0.8, 0.015, 0.12);
  scenes::add_noise(scene.depth, sigma_m, 7);
  return scene;
}

inline scenes::DepthScene with_holes(scenes::DepthScene scene, double fraction = 0.3) {
  scenes::add_holes(scene.depth, fraction, 5, kNoDepth);
  return scene;
}

}  // namespace remote_touch::depth_cases
