#include "tests/core/depth/reference_depth_pipeline.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace remote_touch {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

// Points in the camera frame, pixel by pixel; NaN where there is none.
struct Points {
  CameraIntrinsics camera;
  std::vector<Vec3> p;

  // work(p) for all points in the window around (u, v), that of the pixel itself included.
  template <class Work>
  void window(int u, int v, int size, const Work& work) const {
    for (int j = v - size / 2; j <= v + size / 2; ++j)
      for (int i = u - size / 2; i <= u + size / 2; ++i) {
        if (i < 0 || i >= camera.width || j < 0 || j >= camera.height) continue;
        const Vec3& point = p[static_cast<std::size_t>(j * camera.width + i)];
        if (point.allFinite()) work(point);
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

// (7.1), (7.2)
Points filtered(const DepthPipelineSettings& settings, const Points& raw) {
  return unprojected(raw.camera, [&](int u, int v) {
    const Vec3& p0 = raw.p[static_cast<std::size_t>(v * raw.camera.width + u)];
    if (!p0.allFinite()) return kNoValue;
    double sum = 0, total = 0;
    raw.window(u, v, settings.filter_window, [&](const Vec3& p) {
      const double phi = std::exp(-(p - p0).squaredNorm() / (2 * settings.sigma_f_m * settings.sigma_f_m));
      sum += p.z() * phi, total += phi;
    });
    return sum / total;
  });
}

double wendland(double q) {
  return q < 1 ? std::pow(1 - q, 4) * (4 * q + 1) : 0;
}

struct Plane {
  Vec3 normal{kNoValue, kNoValue, kNoValue};
  double gap = 0, middle = 0;
};

Plane plane(const DepthPipelineSettings& settings, const Points& points, int u, int v) {
  const Vec3& p0 = points.p[static_cast<std::size_t>(v * points.camera.width + u)];
  if (!p0.allFinite()) return {};
  double total = 0;
  Vec3 mean = Vec3::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  points.window(u, v, settings.normal_window, [&](const Vec3& p) {
    const Vec3 d = p - p0;
    const double psi = wendland(d.norm() / settings.normal_radius_m);
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

}  // namespace

ReferenceDepth reference_depth_pipeline(const DepthPipelineSettings& settings, const DepthImage& depth,
                                        const CameraIntrinsics& camera, const RigidTransform& X_WC) {
  const Points raw = unprojected(camera, [&](int u, int v) {
    const double z = depth.z_m[static_cast<std::size_t>(v * depth.width + u)];
    return z > 0 && z < kMaxDepth_m ? z : kNoValue;
  });
  const Points points = settings.filter ? filtered(settings, raw) : raw;
  ReferenceDepth reference;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Plane found = plane(settings, points, u, v);
      const Vec3& p = points.p[static_cast<std::size_t>(v * camera.width + u)];
      reference.cloud.append(X_WC * p, X_WC.linear() * found.normal);
      reference.gap.push_back(found.gap), reference.middle.push_back(found.middle);
    }
  reference.cloud.image = ImageLayout{camera, X_WC, 1e-6};
  return reference;
}

}  // namespace remote_touch
