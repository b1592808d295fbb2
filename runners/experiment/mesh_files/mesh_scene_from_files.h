// A scene of meshes as a scenario of the program: a mesh of the user under the hand.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "runners/experiment/mesh_files/placed_mesh.h"
#include "scenarios/meshes/mesh_scene.h"
#include "scenarios/meshes/pose_file.h"

namespace remote_touch {

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

  // Throws as load(const PlacedMesh&, ...) does. Pre: validate(settings) is empty.
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
std::vector<RecordingPart> input_files(const MeshSceneFromFiles::Settings& s);

}  // namespace remote_touch
