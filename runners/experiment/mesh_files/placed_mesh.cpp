#include "runners/experiment/mesh_files/placed_mesh.h"

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/rotation.h"
#include "core/geometry/vector.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/mesh_sides.h"
#include "core/mesh/welded_mesh.h"
#include "runners/experiment/mesh_files/named_mesh.h"
#include "scenarios/meshes/checked_object.h"
#include "scenarios/text_files/refuse.h"

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

std::vector<RecordingPart> input_files(const PlacedMesh& s) {
  std::vector<RecordingPart> files = mesh_files_of(s.mesh);
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

}  // namespace remote_touch
