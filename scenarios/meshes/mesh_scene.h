// A scene of triangle meshes, at rest or moving as rigid bodies, before a simulated depth sensor.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/meshes/mesh_camera.h"

namespace remote_touch {

// World frame: y up. Frame j shows the objects where they are at captured_s(j), all pixels at once. The true
// surface is known at every time, also between frames. Objects that intersect or enclose each other count as
// their union.
class MeshScene : public Scenario {
 public:
  struct Settings {
    double frame_rate_hz = 30;
    double duration_s = 0;
    DepthSensorSettings sensor{
        .camera = {.camera_position_m = {0, 0.5, 0.35}, .target_position_m = {0, 0.03, 0}}};
  };

  // camera_path: camera to world frame; empty: the camera rests where the settings place it. Keeps a
  // reference to the kernels. Pre: validate(settings) is empty.
  MeshScene(const Settings& settings, std::vector<SceneMesh> meshes,
            const std::optional<PosePath>& camera_path, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  // Number of frames up to and including the first one in which all motion has ended; the largest int if the
  // noise changes in every frame.
  int frame_count() const override;
  std::vector<Phase> phases() const override;
  // Has colours if any object has one. The frames that were used last are kept, see KeptFrames.
  PointCloud cloud(int frame) const override;
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  // Distance to the nearest object, see nearest_on_objects(); exact outside of closed objects. Inside of
  // several objects it is the depth below the surface of the deepest. NaN farther than 1 m from every object
  // and beyond the border of an open one.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // The normal of the nearest object at its nearest point; at an edge or a corner the mean of its faces,
  // weighted by their angles.
  Vec3 true_normal(const Vec3& p_W, double time_s) const override;
  std::vector<PosedMesh> true_meshes(double time_s) const override {
    return posed_meshes(objects_, poses(time_s));
  }
  // A note for each closed object that is at no time in the image, as far as 30 moments show.
  std::vector<Note> input_notes() const override;

 private:
  PointCloud made(int frame) const;
  double moving_time_s(double time_s) const;
  std::vector<std::optional<RigidTransform>> poses(double time_s) const;
  NearestOnObjects nearest(const Vec3& p_W, double time_s) const;

  const Settings settings_;
  const std::vector<SceneMesh> meshes_;
  std::vector<MeshObject> objects_;  // the objects of meshes_
  MeshCamera camera_;
  const bool camera_has_path_;
  double motion_ends_s_ = 0;             // 0: nothing moves
  std::optional<SceneView> still_view_;  // view of a scene in which nothing moves
  // 12 MB each. A hand uses a frame from its capture on, and the renderer when it arrives: up to 0.1 s later.
  mutable KeptFrames frames_{4};
};

Parameters parameters(MeshScene::Settings& s);
inline std::string validate(const MeshScene::Settings& s) {
  return validate(s.sensor);
}

}  // namespace remote_touch
