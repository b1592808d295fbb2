// A depth sensor that looks at meshes which move as rigid bodies.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry/point_cloud.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"
#include "scenarios/camera/depth_sensor.h"
#include "scenarios/meshes/mesh_object.h"
#include "scenarios/meshes/pose_path.h"

namespace remote_touch {

// An object of a scene of meshes.
struct SceneMesh {
  MeshObject object;
  PosePath path{RigidTransform::Identity()};  // object to world frame
  std::optional<std::uint32_t> colour = {};   // 0xRRGGBB, of the whole object
};

class MeshCamera {
 public:
  // X_WC: camera to world frame; empty: the camera rests where its settings place it. Keeps a reference to
  // the kernels. Pre: validate(settings) is empty.
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

}  // namespace remote_touch
