#include "tests/core/dissertation/depth/reference_depth_pipeline.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/dissertation/proxy/proxy_motion.h"

namespace remote_touch {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// Points in the camera frame, pixel by pixel; NaN where there is none.
struct Points {
  CameraIntrinsics camera;
  std::vector<Vec3> p;

  // Calls work(p, i, j) for every finite point in the window around pixel (u, v), including the pixel itself.
  // i and j are the column and the row relative to (u, v). Visits every step-th column and row.
  template <class Work>
  void window(int u, int v, int size, int step, const Work& work) const {
    for (int j = -(size / 2); j <= size / 2; j += step)
      for (int i = -(size / 2); i <= size / 2; i += step) {
        if (u + i < 0 || u + i >= camera.width || v + j < 0 || v + j >= camera.height) continue;
        const Vec3& point = p[static_cast<std::size_t>((v + j) * camera.width + u + i)];
        if (point.allFinite()) work(point, i, j);
      }
  }
};

template <class Depth>
Points unprojected(const CameraIntrinsics& camera, const Depth& depth) {
  Points points{camera, {}};
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) points.p.push_back(unproject(camera, u, v, depth(u, v)));
  return points;
}

Points filtered(const DepthPipelineSettings& settings, const Points& raw) {
  return unprojected(raw.camera, [&](int u, int v) {
    const Vec3& p0 = raw.p[static_cast<std::size_t>(v * raw.camera.width + u)];
    if (!p0.allFinite()) return kNoValue;
    std::vector<Vec3> window;
    raw.window(u, v, settings.filter_window, 1, [&](const Vec3& p, int, int) { window.push_back(p); });
    return equations::filtered_depth(window, p0, settings.sigma_f_m);  // (7.1)
  });
}

struct Plane {
  Vec3 normal{kNoValue, kNoValue, kNoValue};
  double gap = 0, middle = 0;
  // Fit of the inverse depth, 1 / z = abc . (i, j, 1).
  // error: weighted mean of (z abc . (i, j, 1) - 1)^2.
  Vec3 abc{kNoValue, kNoValue, kNoValue};
  double error = kNoValue;
};

Plane plane(const DepthPipelineSettings& settings, const Points& points, int u, int v) {
  const Vec3& p0 = points.p[static_cast<std::size_t>(v * points.camera.width + u)];
  if (!p0.allFinite()) return {};
  double total = 0;
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  points.window(u, v, settings.normal_window, settings.normal_step, [&](const Vec3& p, int, int) {
    const Vec3 d = p - p0;
    const double psi = equations::weight(d.norm(), 0.0, settings.normal_radius_m);
    total += psi, mean += psi * d, squares += psi * d * d.transpose();
  });
  mean /= total;
  const Eigen::Matrix3d covariance = squares / total - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(covariance);
  const Vec3 values = solved.eigenvalues() / covariance.trace();
  Plane found{solved.eigenvectors().col(0), values[1] - values[0], values[1]};
  if (found.normal.dot(p0) > 0) found.normal = -found.normal;
  const double minors = values[1] * values[2] + values[0] * (values[1] + values[2]);
  if (!(minors > kThinnest)) found.normal = Vec3(kNoValue, kNoValue, kNoValue);
  return found;
}

// The plane A x + B y + C z = 1 through the neighbours (a z, b z, z), where a and b are affine in the pixel.
// Solves 1 / z = A i + B j + C for the pixels (i, j) by least squares, with each equation multiplied by z.
Plane plane_of_inverse_depth(const DepthPipelineSettings& settings, const Points& points, int u, int v) {
  const Vec3& p0 = points.p[static_cast<std::size_t>(v * points.camera.width + u)];
  if (!p0.allFinite()) return {};
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  points.window(u, v, settings.normal_window, settings.normal_step, [&](const Vec3& p, int i, int j) {
    const double q = (p - p0).norm() / settings.normal_radius_m, weight = q < 1 ? std::pow(1 - q * q, 2) : 0;
    const Vec3 row = p.z() * Vec3(i, j, 1);
    left += weight * row * row.transpose(), right += weight * row;
  });
  const Eigen::Vector2d mean = left.block<2, 1>(0, 2) / left(2, 2);
  const Eigen::Matrix2d covariance = left.topLeftCorner<2, 2>() / left(2, 2) - mean * mean.transpose();
  Plane found;
  found.gap = 1, found.middle = covariance.determinant() / std::pow(covariance.trace(), 2);
  if (!(found.middle > kThinnest)) return found;
  const Vec3 solved = left.fullPivLu().solve(right);
  double squares = 0;
  points.window(u, v, settings.normal_window, settings.normal_step, [&](const Vec3& p, int i, int j) {
    const double q = (p - p0).norm() / settings.normal_radius_m, weight = q < 1 ? std::pow(1 - q * q, 2) : 0;
    squares += weight * std::pow(p.z() * solved.dot(Vec3(i, j, 1)) - 1, 2);
  });
  found.abc = solved, found.error = p0.z() * p0.z() * squares / left(2, 2);
  const double x = solved.x() * points.camera.fx, y = solved.y() * points.camera.fy;
  found.normal = -Vec3(x, y, solved.z() - x * p0.x() / p0.z() - y * p0.y() / p0.z()).normalized();
  if (found.normal.dot(p0) > 0) found.normal = -found.normal;
  return found;
}

// The normals of `planes` that a pixel may have: the one with the least error, and others whose errors differ
// from it by less than the rounding of single precision.
struct Taken {
  Vec3 normal;
  double gap;
  std::vector<Vec3> as_good;
};

Taken sharp_normal(const DepthPipelineSettings& settings, const Points& points,
                   const std::vector<Plane>& planes, int u, int v) {
  constexpr double kRounding = 0.01, kMinError = 1e-9;
  const auto at = [&](int column, int row) {
    return static_cast<std::size_t>(row * points.camera.width + column);
  };
  const Plane& own = planes[at(u, v)];
  Taken best{own.normal, own.gap, {own.normal}};
  if (!own.normal.allFinite()) return best;
  const int shift = settings.normal_window / 2 + (settings.filter ? settings.filter_window / 2 : 0);
  std::vector<std::pair<double, const Plane*>> all = {{std::min(own.error / 4, 1.0), &own}};
  for (int j = -shift; j <= shift; j += shift)
    for (int i = -shift; i <= shift; i += shift) {
      const bool inside =
          u + i >= 0 && u + i < points.camera.width && v + j >= 0 && v + j < points.camera.height;
      if (!inside || (i == 0 && j == 0)) continue;
      const Plane& plane = planes[at(u + i, v + j)];
      if (!plane.normal.allFinite()) continue;
      const double beside = points.p[at(u, v)].z() * plane.abc.dot(Vec3(-i, -j, 1)) - 1;
      all.emplace_back(plane.error + beside * beside, &plane);
    }
  const auto min = *std::min_element(all.begin(), all.end(),
                                     [](const auto& a, const auto& b) { return a.first < b.first; });
  best = {min.second->normal, min.second->gap, {}};
  for (const auto& [error, plane] : all) {
    if (!(error <= min.first * (1 + kRounding) + kMinError)) continue;
    best.as_good.push_back(plane->normal);
    if (plane->middle < 1e-3) best.gap = 0;  // this normal is not well determined
  }
  return best;
}

}  // namespace

ReferenceDepth reference_depth_pipeline(const DepthPipelineSettings& settings, const DepthImage& depth,
                                        const CameraIntrinsics& camera, const RigidTransform& X_WC) {
  const Points raw = unprojected(camera, [&](int u, int v) {
    const double z = depth.z_m[static_cast<std::size_t>(v * depth.width + u)];
    return z > 0 && z < kMaxDepth_m ? z : kNoValue;
  });
  const Points points = settings.filter ? filtered(settings, raw) : raw;
  ReferenceDepth reference;
  const auto fit = settings.normal_fit == NormalFit::inverse_depth ? plane_of_inverse_depth : plane;
  std::vector<Plane> planes;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) planes.push_back(fit(settings, points, u, v));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const int u = static_cast<int>(i) % camera.width, v = static_cast<int>(i) / camera.width;
    Taken taken{planes[i].normal, planes[i].gap, {planes[i].normal}};
    if (settings.sharp_edges) taken = sharp_normal(settings, points, planes, u, v);
    for (Vec3& normal : taken.as_good) normal = X_WC.linear() * normal;
    reference.cloud.append(X_WC * points.p[i], X_WC.linear() * taken.normal);
    reference.gap.push_back(taken.gap), reference.middle.push_back(planes[i].middle);
    reference.as_good.push_back(std::move(taken.as_good));
  }
  reference.cloud.image = ImageLayout{camera, X_WC, 1e-6};
  return reference;
}

}  // namespace remote_touch
