#include "runners/experiment/mesh_files/mesh_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "core/mesh/mesh_distance.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"
#include "scenarios/files/input_files.h"
#include "scenarios/objects/mesh_object.h"

namespace remote_touch {
namespace {

// "#c08040" as 0xRRGGBB; nothing if it is no such text.
std::optional<std::uint32_t> colour_in(const std::string& text) {
  constexpr std::size_t kDigits = 6;
  std::uint32_t colour = 0;
  if (text.size() != 1 + kDigits || text[0] != '#') return {};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, colour, 16);
  return stop == end && error == std::errc() ? std::optional(colour) : std::nullopt;
}

std::string subject_of(const PlacedMesh& s, const std::string& prefix) {
  return "scenario." + prefix + "mesh = " + s.mesh;
}

// Returns the box of the vertices that triangles use.
BoundingBox box_of_triangles(const TriangleMesh& mesh, const RigidTransform& X_WO) {
  BoundingBox box;
  for (const auto& triangle : mesh.triangles)
    for (const int corner : triangle) box.extend(X_WO * mesh.vertices[static_cast<std::size_t>(corner)]);
  return box;
}

void scale_to(double size_m, const std::string& subject, TriangleMesh& mesh) {
  const double longest = box_of_triangles(mesh, RigidTransform::Identity()).sizes().maxCoeff();
  if (!(longest > 0)) refuse(subject, "its bounding box has no size: expected a surface");
  for (Vec3& vertex : mesh.vertices) vertex *= size_m / longest;
}

// Returns true if the mesh is closed and its solid lies behind all of its faces, or on both sides.
bool is_outward_solid(const TriangleMesh& mesh) {
  const TriangleMesh welded = welded_mesh(mesh);
  if (welded.triangles.empty() || !is_closed_surface(welded)) return false;
  return !has_inverted_part_in(welded, face_sides(welded));
}

TriangleMesh checked_mesh(const PlacedMesh& s, const std::string& prefix) {
  TriangleMesh mesh = mesh_named("scenario." + prefix + "mesh", s.mesh);
  const MeshCheck check = check_mesh(mesh);
  if (!check.readable()) refuse(subject_of(s, prefix), text(check), ": expected a mesh of triangles");
  MeshRepair repaired;
  if (s.repair && !is_outward_solid(mesh)) mesh = repair_mesh(mesh, repaired);
  if (s.size_m > 0) scale_to(s.size_m, subject_of(s, prefix), mesh);
  return mesh;
}

// Returns the displacement that puts the middle of the bottom of the bounding box at the origin.
Vec3 to_bottom(const TriangleMesh& mesh, const RigidTransform& X_WO) {
  const BoundingBox box = box_of_triangles(mesh, X_WO);
  const Vec3 middle = box.center();
  return {-middle.x(), -box.min().y(), -middle.z()};
}

constexpr std::size_t kMotionColumns = 7;

// Returns the displacements and turns of the motion; the identity without one.
std::vector<StampedPose> motion_of(const PlacedMesh& s) {
  if (s.motion.empty()) return {StampedPose{}};
  std::vector<StampedPose> poses;
  for (std::size_t i = 0; i + kMotionColumns <= s.motion.size(); i += kMotionColumns) {
    const double* const row = s.motion.data() + i;
    const Vec3 turn_deg(row[4], row[5], row[6]);
    poses.push_back(
        {row[0], Eigen::Translation3d(row[1], row[2], row[3]) * rotation(kRadiansPerDegree * turn_deg)});
  }
  return poses;
}

// Returns the path of the object in the world frame. With a motion the mesh is moved to a frame whose origin
// is at position_m, because a pose path moves the origin of its body on straight lines. At most one of
// `motion` and `path` has several poses.
PosePath placed_path(const PlacedMesh& s, const std::vector<StampedPose>& path, TriangleMesh& mesh) {
  const RigidTransform rotated(rotation(kRadiansPerDegree * s.rotation_deg));
  const std::vector<StampedPose> motion = motion_of(s);
  Vec3 shift = Vec3::Zero();
  if (s.origin == PlacedMesh::Origin::bottom) shift = to_bottom(mesh, rotated * path.front().X);
  const RigidTransform outer(Eigen::Translation3d(s.position_m));
  RigidTransform inner = Eigen::Translation3d(shift) * rotated;
  if (!s.motion.empty()) {
    for (Vec3& vertex : mesh.vertices) vertex = inner * vertex;
    inner = RigidTransform::Identity();
  }
  std::vector<StampedPose> poses;
  for (const StampedPose& moved : motion)
    for (const StampedPose& pose : path)
      poses.push_back({moved.time_s + pose.time_s, outer * moved.X * inner * pose.X});
  return PosePath(std::move(poses));
}

std::string motion_problem(const PlacedMesh& s, const std::string& prefix) {
  const std::string name = prefix + "mesh_motion";
  if (!s.motion.empty() && !s.path.empty())
    return name + ": expected no motion beside " + prefix + "mesh_path = " + s.path;
  for (std::size_t i = kMotionColumns; i + kMotionColumns <= s.motion.size(); i += kMotionColumns)
    if (!(s.motion[i] > s.motion[i - kMotionColumns]))
      return name + ": row " + std::to_string(i / kMotionColumns) +
             ": expected a later time than in the row before";
  return {};
}

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
  return mesh.object.name +
         formatted(": %zu triangles, %.3f x %.3f x %.3f m", mesh.object.shape->triangles().size(),
                   sides_m.x(), sides_m.y(), sides_m.z()) +
         (mesh.object.shape->crosses_itself() ? ", its faces cross each other" : "");
}

std::string text_of(const Vec3& camera_W) {
  return formatted("camera at (%.3f, %.3f, %.3f) m", camera_W.x(), camera_W.y(), camera_W.z());
}

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
                                  : std::optional(read_poses(find_input(name), PoseLines::stamped)));
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

Parameters parameters(PlacedMesh& s, const std::string& prefix) {
  return {
      {prefix + "mesh", &s.mesh, 0, 0,
       "object: " + names_of_built_in_meshes() + "; or a mesh, OBJ, PLY or STL; empty: none"},
      {prefix + "mesh_size_m", &s.size_m, 0, 10,
       "longest side of the object's bounding box in its own frame; 0: the mesh is in metres"},
      {prefix + "mesh_origin", choice(s.origin, {"bottom", "file"}), 0, 0,
       "what is at the position: the middle of the bottom of the bounding box, or the origin of the file"},
      {prefix + "mesh_position_m", &s.position_m, -10, 10, "position of the object at the start"},
      {prefix + "mesh_rotation_deg", &s.rotation_deg, -360, 360,
       "rotation vector of the object; -90,0,0 turns z up to y up"},
      {prefix + "mesh_motion", Rows{{"time_s", "x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"}, &s.motion},
       -1000, 1000,
       "motion: times, displacements and rotation vectors, world frame, about the position; between "
       "rows straight, by the smaller angle, and at constant rate"},
      {prefix + "mesh_path", &s.path, 0, 0,
       "file of poses over time instead, `t tx ty tz qx qy qz qw` or as its first line names them, of the object "
       "in the frame that position and rotation place; empty: none"},
      {prefix + "mesh_colour", &s.colour, 0, 0, "colour of the object, #rrggbb; empty: none"},
      {prefix + "mesh_sheet", &s.sheet, 0, 0,
       "the mesh is an open surface, whose outside is the side of its normals"},
      {prefix + "mesh_repair", &s.repair, 0, 0,
       "repair a mesh that is not closed: weld vertices, orient faces, fill holes"},
  };
}

std::string validate(const PlacedMesh& s, const std::string& prefix) {
  if (s.mesh.empty()) return {};
  if (!s.colour.empty() && !colour_in(s.colour))
    return prefix + "mesh_colour = " + s.colour + ": expected # and six hexadecimal digits, or nothing";
  if (s.sheet && s.repair)
    return prefix + "mesh_repair = true: closes a mesh, expected " + prefix + "mesh_sheet = false";
  if (std::string problem = motion_problem(s, prefix); !problem.empty()) return problem;
  return mesh_name_problem(prefix + "mesh", s.mesh);
}

std::vector<InputPart> input_files(const PlacedMesh& s) {
  std::vector<InputPart> files = mesh_files_of(s.mesh);
  if (!s.mesh.empty() && !s.path.empty()) files.push_back({s.path});
  return files;
}

SceneMesh load(const PlacedMesh& s, const std::string& prefix, const PosePath& path_of_file) {
  TriangleMesh mesh = checked_mesh(s, prefix);
  PosePath path = placed_path(s, path_of_file.poses(), mesh);
  const std::string setting = "scenario." + prefix;
  const std::string if_inverted = ", or " + setting + "mesh_repair=true";
  const std::string if_open =
      (s.repair ? " after its repair, or " : ", " + setting + "mesh_repair=true or ") + setting +
      "mesh_sheet=true";
  MeshObject object = checked_object(
      std::filesystem::path(s.mesh).stem().string(), mesh, !s.sheet,
      {subject_of(s, prefix), if_open, if_inverted, "; " + setting + "mesh_size_m scales the mesh"});
  return {std::move(object), std::move(path), colour_in(s.colour)};
}

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

std::vector<InputPart> input_files(const MeshSceneFromFiles::Settings& s) {
  std::vector<InputPart> files;
  for (const PlacedMesh& object : s.objects)
    for (InputPart& file : input_files(object)) files.push_back(std::move(file));
  if (!s.camera_path.empty()) files.push_back({s.camera_path});
  return files;
}

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
