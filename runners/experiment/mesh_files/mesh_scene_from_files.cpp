#include "runners/experiment/mesh_files/mesh_scene_from_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "core/geometry/vector.h"

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
  return t.max_disparity_px > 0 ? t.focal_px * t.baseline_m / t.max_disparity_px : 0;
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
  return mesh.object.name + sides +
         (mesh.object.shape->crosses_itself() ? ", its faces cross each other" : "");
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
       "file of camera poses over time, `t tx ty tz qx qy qz qw` or as its first line names them; empty: at rest"},
      {"pose_direction", choice(s.pose_direction, {"camera-to-world", "world-to-camera"}), 0, 0,
       "what the poses of camera_path transform"},
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

namespace {

// The paths of the files of poses that a scene names, on one clock.
class ScenePaths {
 public:
  ScenePaths(const MeshSceneFromFiles::Settings& s, std::vector<Note>& notes) {
    for (const PlacedMesh& object : s.objects) add(object.mesh.empty() ? "" : object.path);
    add(s.camera_path);
    std::vector<const PoseFile*> files;
    for (const auto& file : files_)
      if (file) files.push_back(&*file);
    const std::vector<double> origins_s = origins_of_clocks(files, notes);
    for (std::size_t i = 0, next = 0; i < files_.size(); ++i) {
      if (!files_[i]) continue;
      paths_[i] = path_of(*files_[i], origins_s[next++]);
      if (i + 1 == files_.size() && s.pose_direction == PoseDirection::world_to_camera)
        paths_[i] = inverse(*paths_[i]);
      const bool may_be_reordered = files_[i]->has_unnamed_quaternions && i + 1 < files_.size();
      const std::string name = files_[i]->file.filename().string();
      for (const auto& more : {files_[i]->notes, unusual_poses(name, paths_[i]->poses(), may_be_reordered)})
        notes.insert(notes.end(), more.begin(), more.end());
      text_ += "; " + name + ": " + motion_text(paths_[i]->poses());
    }
  }

  // i: index of an object, or kCamera.
  static constexpr std::size_t kCamera = 3;
  const std::optional<PosePath>& operator[](std::size_t i) const { return paths_[i]; }
  // Describes what was read of each, for the user.
  const std::string& text() const { return text_; }

 private:
  void add(const std::string& name) {
    files_.push_back(name.empty() ? std::nullopt
                                  : std::optional(read_poses(find_recording(name), PoseLines::stamped)));
    paths_.emplace_back();
  }
  static PosePath inverse(const PosePath& path) {
    std::vector<StampedPose> poses = path.poses();
    for (StampedPose& pose : poses) pose.X = pose.X.inverse();
    return PosePath(std::move(poses));
  }

  std::vector<std::optional<PoseFile>> files_;
  std::vector<std::optional<PosePath>> paths_;
  std::string text_;
};

}  // namespace

MeshSceneFromFiles::Parts MeshSceneFromFiles::read(const Settings& s) {
  Parts parts{{}, {}, s.scene, {}, {}};
  const ScenePaths paths(s, parts.notes);
  BoundingBox box;
  for (std::size_t i = 0; i < kPrefixes.size(); ++i) {
    if (s.objects[i].mesh.empty()) continue;
    const PosePath at_rest(RigidTransform::Identity());
    parts.meshes.push_back(load(s.objects[i], kPrefixes[i], paths[i].value_or(at_rest)));
    box.extend(box_of(parts.meshes.back()));
    parts.input += text_of(parts.meshes.back()) + "; ";
  }
  if (s.table) parts.meshes.push_back(table_around(box, s.table_height_m));
  parts.camera_path = paths[ScenePaths::kCamera];
  if (s.camera_fit && !parts.camera_path && !box.isEmpty()) fit(box, parts.scene.sensor);
  parts.input += text_of(parts.camera_path ? parts.camera_path->at(0).translation().eval()
                                           : parts.scene.sensor.camera.camera_position_m);
  parts.input += paths.text();
  return parts;
}

MeshSceneFromFiles::MeshSceneFromFiles(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : MeshSceneFromFiles(read(settings), key, kernels) {}

MeshSceneFromFiles::MeshSceneFromFiles(Parts parts, const NoiseKey& key, const Kernels& kernels)
    : MeshScene(parts.scene, std::move(parts.meshes), parts.camera_path, key, kernels),
      input_(std::move(parts.input)),
      notes_(std::move(parts.notes)) {}

std::vector<Note> MeshSceneFromFiles::input_notes() const {
  std::vector<Note> notes = notes_, more = MeshScene::input_notes();
  notes.insert(notes.end(), more.begin(), more.end());
  return notes;
}

}  // namespace remote_touch
