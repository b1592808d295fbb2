// Scenarios with meshes of the user: a scene of meshes, and a recording whose true surface comes from mesh
// files.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/objects/mesh_scene.h"
#include "scenarios/recordings/recorded_scene.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// A mesh that a user names and places in a scene: its size, its pose or path of poses, and its colour.

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
std::vector<InputPart> input_files(const PlacedMesh& s);

// Reads the mesh. path: the content of the file `path`; a pose at rest without a file. A mesh that is not
// closed or not outwards everywhere is repaired if `repair` is set. Throws MissingInput if the file is
// not there, and InputError as read_mesh() and checked_object() do, and if a part of the mesh is inside out
// and is no hollow of another part. Pre: mesh is not empty, validate() finds no problem.
SceneMesh load(const PlacedMesh& s, const std::string& prefix, const PosePath& path);

// A scene of meshes as a scenario of the program: a mesh of the user under the hand.
class MeshSceneFromFiles final : public MeshScene {
 public:
  struct Settings {
    MeshScene::Settings scene{
        .sensor = {.camera = {.camera_position_m = {0, 0.5, 0.35}, .target_position_m = {0, 0.03, 0}},
                   .max_depth_m = 10}};
    // The objects; their parameters begin with "", "second_" and "third_".
    std::array<PlacedMesh, 3> objects = {PlacedMesh{.mesh = "husky", .size_m = 0.2}};
    // A square sheet that faces up, around the middle of the objects at the start. Its side is 1 m, or twice
    // the diagonal of the objects' bounding box if that is longer.
    bool table = true;
    double table_height_m = 0;
    std::string camera_path;  // file of stamped poses of the camera, x right, y down, z forward
    PoseDirection pose_direction = PoseDirection::camera_to_world;
    // Moves the target to the middle of the objects at the start, and the camera along its line of sight, so
    // that they fill the image, or are as near as the sensor measures. Without effect on a camera with a
    // path.
    bool camera_fit = true;
  };

  // Throws as load(const PlacedMesh&, ...) does.
  MeshSceneFromFiles(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  // "husky: 5316 triangles, 0.200 x 0.042 x 0.143 m; camera at (0.00, 0.31, 0.22) m; path.txt: 12 poses over
  // 1.1 s at 10 Hz, 0.3 m long, at most 0.5 m/s"
  std::string input() const override { return input_; }
  // Notes on the files of poses, and on objects out of view.
  std::vector<Note> input_notes() const override;

 private:
  struct Parts {
    std::vector<SceneMesh> meshes;
    std::optional<PosePath> camera_path;
    MeshScene::Settings scene;
    std::string input;
    std::vector<Note> notes;
  };
  static Parts read(const Settings& settings);
  MeshSceneFromFiles(Parts parts, const NoiseKey& key, const Kernels& kernels);

  std::string input_;
  std::vector<Note> notes_;
};

Parameters parameters(MeshSceneFromFiles::Settings& s);
std::string validate(const MeshSceneFromFiles::Settings& s);
std::vector<InputPart> input_files(const MeshSceneFromFiles::Settings& s);

// A recording as a scenario whose true surface may come from mesh files.
class RecordingWithTruth final : public RecordedScene {
 public:
  using Settings = RecordedScene::Settings;
  RecordingWithTruth(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : RecordedScene(settings, key, kernels,
                      [](const std::filesystem::path& file) { return read_mesh(file); }) {}
};

}  // namespace remote_touch
