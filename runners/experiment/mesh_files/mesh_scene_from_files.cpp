#include "runners/experiment/mesh_files/mesh_scene_from_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "core/geometry/bounding_box.h"
#include "scenarios/meshes/pose_file.h"

namespace remote_touch {

namespace {

constexpr std::array<const char*, 3> kPrefixes = {"", "second_", "third_"};

SceneMesh table_around(const BoundingBox& box, double height_m) {
  const double a = box.isEmpty() ? 0.5 : std::max(0.5, box.diagonal().norm());
  const TriangleMesh plate = {{{-a, 0, a}, {a, 0, a}, {a, 0, -a}, {-a, 0, -a}}, {{0, 1, 2}, {0, 2, 3}}};
  RigidTransform X_WO = RigidTransform::Identity();
  if (!box.isEmpty()) X_WO.translation() = box.center();
  X_WO.translation().y() = height_m;
  return {{"table", std::make_shared<const MeshDistance>(plate), false}, PosePath(X_WO)};
}

BoundingBox box_of(const SceneMesh& mesh) {
  BoundingBox box;
  const RigidTransform X_WO = mesh.path.at(0);
  for (const Vec3& vertex : mesh.object.shape->vertices()) box.extend(X_WO * vertex);
  return box;
}

// Returns the depth of the nearest surface that the sensor measures.
double nearest_depth_m(const DepthSensorSettings& sensor) {
  if (sensor.sensor == DepthSensorKind::simple) return 0;
  const Triangulation t = triangulation(sensor);
  return t.max_disparity_px > 0 ? sensor.camera.focal_px * t.baseline_m / t.max_disparity_px : 0;
}

// Places the camera where a ball around the box fills the smaller side of the image, or farther away, where
// the nearest point of the ball is not too near for the sensor.
void fit(const BoundingBox& box, DepthSensorSettings& sensor) {
  DepthCameraSettings& camera = sensor.camera;
  const double half_image_px = 0.5 * std::min(camera.width, camera.height);
  const double radius_m = 0.5 * box.diagonal().norm();
  const double filling_m =
      radius_m * std::sqrt(half_image_px * half_image_px + camera.focal_px * camera.focal_px) / half_image_px;
  const double distance_m = std::max(filling_m, radius_m + nearest_depth_m(sensor));
  const Vec3 back = (camera.camera_position_m - camera.target_position_m).normalized();
  camera.target_position_m = box.center();
  camera.camera_position_m = box.center() + distance_m * back;
}

std::string text_of(const SceneMesh& mesh) {
  const Vec3 sides_m = box_of(mesh).sizes();
  char sides[96];
  std::snprintf(sides, sizeof sides, ": %zu triangles, %.3f x %.3f x %.3f m",
                mesh.object.shape->triangles().size(), sides_m.x(), sides_m.y(), sides_m.z());
  return mesh.object.name + sides;
}

std::string text_of(const Vec3& camera_W) {
  char text[96];
  std::snprintf(text, sizeof text, "camera at (%.3f, %.3f, %.3f) m", camera_W.x(), camera_W.y(),
                camera_W.z());
  return text;
}

}  // namespace

Parameters parameters(MeshSceneFromFiles::Settings& s) {
  Parameters all;
  for (std::size_t i = 0; i < kPrefixes.size(); ++i)
    all = appended(std::move(all), parameters(s.objects[i], kPrefixes[i]));
  const Parameters own = {
      {"table", &s.table, 0, 0,
       "a table below the middle of the objects: a square sheet that faces up, 1 m long, or twice the diagonal of "
       "their bounding box if that is longer"},
      {"table_height_m", &s.table_height_m, -10, 10, "height of the table"},
      {"camera_path", &s.camera_path, 0, 0,
       "file of camera poses over time, `t tx ty tz qx qy qz qw`, camera to world; empty: at rest"},
      {"camera_fit", &s.camera_fit, 0, 0,
       "the camera looks at the middle of the objects, in the direction from camera_position_m to "
       "target_position_m, from where they fill the image, or from the least distance of the sensor"},
  };
  return appended(appended(std::move(all), own), parameters(s.scene));
}

std::string validate(const MeshSceneFromFiles::Settings& s) {
  for (std::size_t i = 0; i < kPrefixes.size(); ++i)
    if (std::string problem = validate(s.objects[i], kPrefixes[i]); !problem.empty()) return problem;
  const bool any = s.table || std::any_of(s.objects.begin(), s.objects.end(),
                                          [](const PlacedMesh& object) { return !object.mesh.empty(); });
  if (!any) return "mesh = \"\": expected an object, or table = true";
  return validate(s.scene);
}

std::vector<RecordingPart> input_files(const MeshSceneFromFiles::Settings& s) {
  std::vector<RecordingPart> files;
  for (const PlacedMesh& object : s.objects)
    for (RecordingPart& file : input_files(object)) files.push_back(std::move(file));
  if (!s.camera_path.empty()) files.push_back({s.camera_path});
  return files;
}

MeshSceneFromFiles::Parts MeshSceneFromFiles::read(const Settings& s) {
  Parts parts{{}, {}, s.scene, {}};
  BoundingBox box;
  for (std::size_t i = 0; i < kPrefixes.size(); ++i) {
    if (s.objects[i].mesh.empty()) continue;
    parts.meshes.push_back(load(s.objects[i], kPrefixes[i]));
    box.extend(box_of(parts.meshes.back()));
    parts.input += text_of(parts.meshes.back()) + "; ";
  }
  if (s.table) parts.meshes.push_back(table_around(box, s.table_height_m));
  if (!s.camera_path.empty()) parts.camera_path = read_stamped_poses(find_recording(s.camera_path));
  if (s.camera_fit && !parts.camera_path && !box.isEmpty()) fit(box, parts.scene.sensor);
  parts.input += text_of(parts.camera_path ? parts.camera_path->at(0).translation().eval()
                                           : parts.scene.sensor.camera.camera_position_m);
  return parts;
}

MeshSceneFromFiles::MeshSceneFromFiles(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : MeshSceneFromFiles(read(settings), key, kernels) {}

MeshSceneFromFiles::MeshSceneFromFiles(Parts parts, const NoiseKey& key, const Kernels& kernels)
    : MeshScene(parts.scene, std::move(parts.meshes), std::move(parts.camera_path), key, kernels),
      input_(std::move(parts.input)) {}

}  // namespace remote_touch
