// The true surface in the frames of a recording: meshes at their poses.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "core/mesh/triangle_mesh.h"
#include "scenarios/meshes/mesh_object.h"
#include "scenarios/meshes/object_view.h"
#include "scenarios/meshes/truth_folder.h"
#include "scenarios/meshes/truth_masks.h"

namespace remote_touch {

// Reads a mesh file, in the unit of the file. Vertices at the same position are one vertex, as check_mesh()
// needs it. Throws InputError about the file.
using MeshReader = std::function<TriangleMesh(const std::filesystem::path&)>;

// Poses are used at the frames only, not between them. The camera frame C is x right, y down, z forward.
class RecordedTruth {
 public:
  // frames: names of the depth images of the recording's frames, see TruthMasks. camera: the camera of its
  // images; its size is 0 if they are no images.
  //
  // Reads all meshes and poses. Throws InputError about a file in these cases: there is not one pose for each
  // frame; no object has a pose; a mesh has no triangle with an area, or a bounding box with a diagonal above
  // 10 m; an object that is stated to be closed is not; or the triangles of a closed object run clockwise
  // seen from outside. An object of which nothing is stated is closed if MeshDistance::is_closed(). For masks
  // see TruthMasks. Pre: reach_m > 0.
  RecordedTruth(const TruthFolder& folder, const std::vector<std::string>& frames, double reach_m,
                const MeshReader& read_mesh, const CameraIntrinsics& camera);

  // Throws InputError about the poses if no object is in the image in any frame, as if they had another unit
  // or direction. cause: a part of the message that says what would explain it; empty: nothing does. A camera
  // without pixels sees all.
  void require_view(const CameraIntrinsics& camera, const std::string& cause) const;

  // Returns the true surface nearest to p_C, both in the camera frame of the frame. It is unknown farther
  // than reach_m from every object, beyond the border of an open one, for objects without a pose in this
  // frame, and outside of the mask. Pre: frame < frame_count. Not for several threads at once. Throws
  // InputError about a mask that cannot be used.
  NearestOnObjects at(std::size_t frame, const Vec3& p_C) const;

  const std::vector<MeshObject>& objects() const { return objects_; }
  // Poses of the objects in a frame, object frame to camera frame; nothing where a pose is unknown.
  std::span<const std::optional<RigidTransform>> poses(std::size_t frame) const {
    return std::span(X_CO_).subspan(frame * objects_.size(), objects_.size());
  }
  // Points on the surface of each object.
  const std::vector<std::vector<SampledPoint>>& samples() const { return samples_; }
  double reach_m() const { return reach_m_; }
  // "truth/ (cube, table)"
  const std::string& name() const { return name_; }
  // Uncertainty of the poses as stated in truth.json; NaN: not stated.
  double uncertainty_m() const { return uncertainty_m_; }

 private:
  std::filesystem::path poses_file_;  // that of the first object
  std::vector<MeshObject> objects_;
  std::vector<std::vector<SampledPoint>> samples_;
  std::vector<std::optional<RigidTransform>> X_CO_;  // element frame * number of objects + object
  TruthMasks masks_;
  double reach_m_, uncertainty_m_;
  std::string name_;
};

}  // namespace remote_touch
