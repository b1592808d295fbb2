// A mesh that a user names and places in a scene: its size, its pose or path of poses, and its colour.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/meshes/mesh_camera.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// The pose of the object in the world frame W, whose y is up, is
//   X_WO(t) = translation(position_m + d(t)) turn(t) translation(shift) rotation(rotation_deg) path(t).
// d(t) and turn(t) are the displacement and the rotation of `motion`, along the axes of the world frame and
// about position_m. path(t) is the pose in the file `path` at the time t on the clock of the scene's files.
// Without them the object rests. `shift` is 0 for the origin of the file; for the bottom it puts the middle
// of the bottom of the object's bounding box at t = 0 at position_m.
struct PlacedMesh {
  enum class Origin { bottom, file };
  std::string mesh;  // name of mesh_named(); empty: no object
  double size_m = 0;
  Origin origin = Origin::bottom;
  Vec3 position_m = Vec3::Zero();
  Vec3 rotation_deg = Vec3::Zero();  // rotation vector
  std::vector<double> motion = {};   // rows of time_s, x_m, y_m, z_m, rx_deg, ry_deg, rz_deg; or
  std::string path = {};             // file of stamped poses, object to its parent frame
  std::string colour = {};           // "#rrggbb"; empty: none
  bool sheet = false;                // an open surface, seen from the side of its normals
  bool repair = false;
};

// prefix: begins the names of all parameters, such as "second_".
Parameters parameters(PlacedMesh& s, const std::string& prefix);
std::string validate(const PlacedMesh& s, const std::string& prefix);
std::vector<RecordingPart> input_files(const PlacedMesh& s);

// Reads the mesh. path: the content of the file `path`; a pose at rest without a file. A mesh that is not
// closed or not outwards everywhere is repaired if `repair` is set. Throws MissingRecording if the file is
// not there, and InputError as read_mesh() and checked_object() do, and if a part of the mesh is inside out
// and is no hollow of another part. Pre: mesh is not empty, validate() finds no problem.
SceneMesh load(const PlacedMesh& s, const std::string& prefix, const PosePath& path);

}  // namespace remote_touch
