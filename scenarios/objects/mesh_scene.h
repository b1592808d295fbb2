// A scene of triangle meshes, at rest or moving as rigid bodies, before a simulated depth sensor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The depth image of triangle meshes, as a pinhole camera without errors would measure it.

// A mesh at rest before a camera. A vertex that several triangles share must be one vertex, or have the same
// coordinates in all of them; otherwise there can be gaps between the triangles.
struct RasterMesh {
  std::span<const Vec3> vertices_O;                  // frame of the object, m
  std::span<const std::array<int, 3>> triangles;     // corners counter-clockwise seen from outside
  RigidTransform X_CO = RigidTransform::Identity();  // object to camera frame
  // True: only triangles that turn their outside to the camera are drawn. False: both sides are drawn.
  bool is_closed = true;
};

// The surface that each pixel sees, row by row.
struct RasterImage {
  DepthImage depth;           // along the optical axis; NaN where the pixel sees nothing
  std::vector<int> mesh;      // index of the mesh; -1 where the pixel sees nothing
  std::vector<int> triangle;  // index of the triangle in its mesh; -1 where the pixel sees nothing
};

// Returns the first surface on the ray r = ((u - cx) / fx, (v - cy) / fy, 1) of every pixel (u, v). Of
// surfaces at equal depths it is the one that comes first in the list. Surfaces nearer than a micrometre are
// not drawn, and neither are triangles that the camera sees edge-on, whose plane contains its centre.
//
// Homogeneous rasterisation without clipping (M. Olano, T. Greer, "Triangle scan conversion using 2D
// homogeneous coordinates", Graphics Hardware 1997): a triangle (a, b, c) covers the pixel if
// e_a = (c x b) . r, e_b = (a x c) . r and e_c = (b x a) . r have the same sign. Two triangles that share an
// edge compute opposite numbers for it, to the last bit, and a triangle includes its border, widened by a
// bound on the rounding errors. So there are no gaps between them, also at vertices that lie on a ray. The
// depth is the mean of the corners' depths with the weights e_a, e_b and e_c. It equals that of exact ray
// casting up to rounding, within 1e-6 m for coordinates up to 10 m.
//
// The bits do not depend on the machine or on the number of threads. Pre: indices in range, vertices finite,
// fx and fy not 0.
RasterImage depth_raster(const CameraIntrinsics& camera, std::span<const RasterMesh> meshes);

// An object of a scene of meshes.
struct SceneMesh {
  MeshObject object;
  PosePath path{RigidTransform::Identity()};  // object to world frame
  std::optional<std::uint32_t> colour = {};   // 0xRRGGBB, of the whole object
};

// A depth sensor that looks at meshes which move as rigid bodies.
class MeshCamera {
 public:
  // X_WC: camera to world frame; empty: the camera rests where its settings place it. Keeps a reference to
  // the kernels.
  MeshCamera(const DepthSensorSettings& settings, std::optional<PosePath> X_WC, const NoiseKey& key,
             const Kernels& kernels);

  const PosePath& path() const { return X_WC_; }
  CameraIntrinsics intrinsics() const { return sensor_.intrinsics(); }
  bool noisy() const { return sensor_.noisy(); }

  // Returns what the sensor sees of the meshes at a time. The view has colours if any of the meshes has one;
  // then kNoColour is that of meshes without, and black that of pixels that see nothing.
  SceneView view(std::span<const SceneMesh> meshes, double time_s) const;
  // Returns the organised cloud of a frame in the world frame, from the view of the time of its capture. A
  // pixel without a depth keeps its colour.
  PointCloud cloud(const SceneView& view, int frame, double time_s) const;

 private:
  DepthSensor sensor_;
  bool needs_cosines_;
  PosePath X_WC_;
};

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
  // reference to the kernels.
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
