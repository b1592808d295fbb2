#include "scenarios/meshes/object_view.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

// Two additive recurrences spread the points within the triangles.
std::vector<SampledPoint> surface_samples(const MeshDistance& shape, std::size_t count) {
  constexpr double kAlong = 0.7548776662466927, kAcross = 0.5698402909980532;
  const std::vector<Vec3>& vertices = shape.vertices();
  std::vector<double> area_up_to;  // sum up to each triangle, times two
  double area = 0;
  for (const auto& [a, b, c] : shape.triangles())
    area_up_to.push_back(area += (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).norm());
  std::vector<SampledPoint> samples;
  for (std::size_t k = 0; k < count; ++k) {
    const double place = area * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, place);
    const auto& [a, b, c] = shape.triangles()[static_cast<std::size_t>(found - area_up_to.begin())];
    const Vec3 side = vertices[b] - vertices[a], other = vertices[c] - vertices[a];
    double along = kAlong * static_cast<double>(k + 1), across = kAcross * static_cast<double>(k + 1);
    along -= std::floor(along), across -= std::floor(across);
    if (along + across > 1) along = 1 - along, across = 1 - across;
    samples.push_back({vertices[a] + along * side + across * other, side.cross(other).normalized()});
  }
  return samples;
}

std::optional<std::size_t> pixel_of(const CameraIntrinsics& camera, const Vec3& p_C) {
  if (!p_C.allFinite() || !(p_C.z() > 0)) return {};
  const double u = std::floor(camera.fx * p_C.x() / p_C.z() + camera.cx + 0.5);
  const double v = std::floor(camera.fy * p_C.y() / p_C.z() + camera.cy + 0.5);
  if (!(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return {};
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u);
}

std::size_t count_in_image(const std::vector<SampledPoint>& samples, const RigidTransform& X_CO,
                           const CameraIntrinsics& camera) {
  return static_cast<std::size_t>(std::count_if(
      samples.begin(), samples.end(),
      [&](const SampledPoint& sample) { return pixel_of(camera, X_CO * sample.point).has_value(); }));
}

}  // namespace remote_touch
