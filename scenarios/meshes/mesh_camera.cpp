#include "scenarios/meshes/mesh_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/geometry/colour.h"
#include "scenarios/meshes/depth_raster.h"

namespace remote_touch {

namespace {

std::vector<RasterMesh> posed(std::span<const SceneMesh> meshes, const RigidTransform& X_CW, double time_s) {
  std::vector<RasterMesh> seen;
  for (const SceneMesh& mesh : meshes) {
    const MeshDistance& shape = *mesh.object.shape;
    seen.push_back({shape.vertices(), shape.triangles(), X_CW * mesh.path.at(time_s), mesh.object.is_closed});
  }
  return seen;
}

// Returns the cosine of the angle between the ray and the normal of each pixel's triangle; 1 where there is
// none.
std::vector<double> cosines(const RasterImage& image, const std::vector<RasterMesh>& meshes,
                            const CameraIntrinsics& camera) {
  std::vector<double> cosine(image.mesh.size(), 1);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      if (image.mesh[i] < 0) continue;
      const RasterMesh& mesh = meshes[static_cast<std::size_t>(image.mesh[i])];
      const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(image.triangle[i])];
      const Vec3& from = mesh.vertices_O[a];
      const Vec3 normal_O = (mesh.vertices_O[b] - from).cross(mesh.vertices_O[c] - from);
      const Vec3 ray_O = mesh.X_CO.linear().transpose() * unproject(camera, u, v, 1);
      cosine[i] = std::abs(normal_O.dot(ray_O)) / std::sqrt(normal_O.squaredNorm() * ray_O.squaredNorm());
    }
  return cosine;
}

std::vector<std::uint32_t> colours(const RasterImage& image, std::span<const SceneMesh> meshes) {
  std::vector<std::uint32_t> colour;
  const bool any = std::any_of(meshes.begin(), meshes.end(),
                               [](const SceneMesh& mesh) { return mesh.colour.has_value(); });
  if (!any) return colour;
  colour.assign(image.mesh.size(), 0);
  for (std::size_t i = 0; i < colour.size(); ++i)
    if (image.mesh[i] >= 0)
      colour[i] = meshes[static_cast<std::size_t>(image.mesh[i])].colour.value_or(kNoColour);
  return colour;
}

}  // namespace

MeshCamera::MeshCamera(const DepthSensorSettings& settings, std::optional<PosePath> X_WC, const NoiseKey& key,
                       const Kernels& kernels)
    : sensor_(settings, key, kernels),
      needs_cosines_(settings.sensor != DepthSensorKind::simple),
      X_WC_(X_WC ? *std::move(X_WC) : PosePath(sensor_.pose())) {}

SceneView MeshCamera::view(std::span<const SceneMesh> meshes, double time_s) const {
  const std::vector<RasterMesh> seen = posed(meshes, X_WC_.at(time_s).inverse(), time_s);
  RasterImage image = depth_raster(sensor_.intrinsics(), seen);
  const std::vector<double> cosine =
      needs_cosines_ ? cosines(image, seen, sensor_.intrinsics()) : std::vector<double>{};
  return sensor_.view(std::move(image.depth), cosine, colours(image, meshes));
}

PointCloud MeshCamera::cloud(const SceneView& view, int frame, double time_s) const {
  PointCloud cloud =
      cloud_from_depth(sensor_.measured_depth(view, frame), sensor_.intrinsics(), X_WC_.at(time_s));
  cloud.colour = view.ideal.colour;
  return cloud;
}

}  // namespace remote_touch
