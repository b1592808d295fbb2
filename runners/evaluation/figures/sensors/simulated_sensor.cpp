#include "runners/evaluation/figures/sensors/simulated_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "scenarios/meshes/mesh_scene.h"

namespace remote_touch {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kOtherSurface_m = 0.05;
constexpr int kSilhouette_px = 3;

std::size_t index_of(const DepthImage& image, int u, int v) {
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u);
}

// Returns the cosine of the angle between the ray of a pixel and the normal of the plane of a window. The
// plane 1 / z = a u + b v + c has the normal (a fx, b fy, a cx + b cy + c), whose product with the ray
// ((u - cx) / fx, (v - cy) / fy, 1) is 1 / z.
double cosine_at(const FittedWindow& window, const CameraIntrinsics& camera, int u, int v) {
  const double middle = 0.5 * (window.width_px - 1);
  const double at_centre = window.inverse_per_m + window.across_per_m * (camera.cx - window.u - middle) +
                           window.down_per_m * (camera.cy - window.v - middle);
  const Vec3 normal(window.across_per_m * camera.fx, window.down_per_m * camera.fy, at_centre);
  const Vec3 ray = unproject(camera, u, v, 1);
  return std::abs(normal.dot(ray)) / std::sqrt(normal.squaredNorm() * ray.squaredNorm());
}

// The true depths, and the objects of the pixels; nothing measured.
ObjectImage true_objects(const RecordedTruth& truth, std::size_t frame, const CameraIntrinsics& camera) {
  std::vector<RasterMesh> meshes;
  std::vector<int> objects;
  for (std::size_t i = 0; i < truth.objects().size(); ++i) {
    const MeshObject& object = truth.objects()[i];
    const auto& X_CO = truth.poses(frame)[i];
    if (!X_CO) continue;
    meshes.push_back({object.shape->vertices(), object.shape->triangles(), *X_CO, object.is_closed});
    objects.push_back(static_cast<int>(i));
  }
  RasterImage raster = depth_raster(camera, meshes);
  for (int& shown : raster.mesh)
    if (shown >= 0) shown = objects[static_cast<std::size_t>(shown)];
  return {std::move(raster.depth), {}, std::move(raster.mesh)};
}

}  // namespace

DepthScene filled_scene(const DepthImage& recorded) {
  DepthScene scene{recorded};
  for (int v = 0; v < recorded.height; ++v) {
    double* z_m = &scene.depth.z_m[index_of(recorded, 0, v)];
    int last = -1;  // column of the last measured pixel
    for (int u = 0; u < recorded.width; ++u) {
      if (std::isnan(z_m[u])) continue;
      if (last >= 0) std::fill(z_m + last + 1, z_m + u, std::max(z_m[last], z_m[u]));
      last = u;
    }
  }
  return scene;
}

DepthScene planar_scene(std::span<const FittedWindow> windows, const CameraIntrinsics& camera) {
  DepthScene scene{{camera.width, camera.height, std::vector<double>(camera.pixels(), kNaN)},
                   std::vector<double>(camera.pixels(), 1)};
  for (const FittedWindow& window : windows)
    for (int v = window.v; v < window.v + window.width_px; ++v)
      for (int u = window.u; u < window.u + window.width_px; ++u) {
        scene.depth.z_m[index_of(scene.depth, u, v)] = window.depth_at(u, v);
        scene.cosine[index_of(scene.depth, u, v)] = cosine_at(window, camera, u, v);
      }
  return scene;
}

DepthSensorSettings sensor_settings(DepthSensorKind kind, const CameraIntrinsics& camera) {
  DepthSensorSettings settings;
  settings.camera.width = camera.width, settings.camera.height = camera.height;
  settings.camera.focal_px = camera.fx;
  settings.sensor = kind;
  return settings;
}

DepthSensorSettings with_own_focal_length(DepthSensorSettings settings, double own_focal_px) {
  const double factor = settings.camera.focal_px / own_focal_px;
  settings.disparity_focal_px = own_focal_px;
  settings.window_px =
      static_cast<int>(std::max(1.0, std::floor(triangulation(settings).window_px * factor + 0.5)));
  return settings;
}

std::vector<DepthImage> simulated_frames(const DepthSensorSettings& settings, const DepthScene& scene,
                                         int count, const Kernels& kernels) {
  const DepthSensor sensor(settings, NoiseKey{}, kernels);
  const auto view = sensor.view(scene.depth, scene.cosine, {});
  std::vector<DepthImage> frames;
  for (int frame = 0; frame < count; ++frame) frames.push_back(sensor.measured_depth(view, frame));
  return frames;
}

ObjectImage recorded_objects(const RecordedTruth& truth, std::size_t frame, const DepthImage& recorded,
                             const CameraIntrinsics& camera) {
  ObjectImage image = true_objects(truth, frame, camera);
  image.measured = recorded;
  return image;
}

ObjectImage simulated_objects(const RecordedTruth& truth, std::size_t frame,
                              const DepthSensorSettings& settings, const Kernels& kernels) {
  std::vector<SceneMesh> meshes;
  for (std::size_t i = 0; i < truth.objects().size(); ++i)
    if (const auto& X_CO = truth.poses(frame)[i]) meshes.push_back({truth.objects()[i], PosePath(*X_CO)});
  const NoiseKey key;
  const MeshCamera camera(settings, PosePath(RigidTransform::Identity()), key, kernels);
  const PointCloud cloud = camera.cloud(camera.view(meshes, 0), static_cast<int>(frame), 0);
  ObjectImage image = true_objects(truth, frame, cloud.image->camera);
  image.measured = {image.true_depth.width, image.true_depth.height, cloud.z};
  return image;
}

std::vector<double> depth_errors_of(const ObjectImage& image, int object) {
  const auto shows = [&](int u, int v) { return image.object[index_of(image.true_depth, u, v)] == object; };
  std::vector<double> errors_m;
  for (int v = kSilhouette_px; v < image.true_depth.height - kSilhouette_px; ++v)
    for (int u = kSilhouette_px; u < image.true_depth.width - kSilhouette_px; ++u) {
      bool is_inside = true;
      for (int d = -kSilhouette_px; d <= kSilhouette_px && is_inside; ++d)
        is_inside = shows(u + d, v) && shows(u, v + d);
      const std::size_t i = index_of(image.true_depth, u, v);
      const double error_m = image.measured.z_m[i] - image.true_depth.z_m[i];
      if (is_inside && std::abs(error_m) < kOtherSurface_m) errors_m.push_back(error_m);
    }
  return errors_m;
}

}  // namespace remote_touch
