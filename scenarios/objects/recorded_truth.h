// The true surface in the frames of a recording: meshes at their poses.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/objects/mesh_object.h"

namespace remote_touch {

// The truth of a recording, in its folder truth/ or in the layout of BOP: which meshes are the true surfaces,
// and their poses.

struct TruthObjectFiles {
  std::string name;             // unique within the folder
  std::filesystem::path mesh;   // OBJ, PLY or STL, triangles counter-clockwise seen from outside
  std::filesystem::path poses;  // see read_poses(): object frame to camera frame, one for each frame
  // True: a solid. False: a sheet that is seen from the side of its normals, such as a table. Nothing: as the
  // mesh is.
  std::optional<bool> closed = {};
  double metres_per_unit = 1;  // size of one unit of the mesh
  // Layout of BOP: the poses by the number of the frame. The file `poses` has those of all objects.
  std::map<std::string, RigidTransform> X_CO = {};
};

struct TruthFolder {
  std::vector<TruthObjectFiles> objects;  // one or more
  double uncertainty_m =
      std::numeric_limits<double>::quiet_NaN();  // uncertainty of the poses; NaN: not stated
  std::filesystem::path masks;                   // folder of masks; empty: none
  std::filesystem::path description;             // truth.json; empty: none
  std::string name = "truth/";                   // the name that messages use
};

// Lists the truth of a recording. Returns nothing if `recording` has no folder truth/. No mesh, pose or mask
// is opened here.
//
// truth/truth.json, if it exists, names the objects: {"objects": [{"name": "cube", "mesh": "cube.obj",
// "poses": "poses.txt", "closed": true}, ...], "uncertainty_m": 0.003}; `closed` and `uncertainty_m` may be
// left out. Files are named relative to truth/ and are inside it. Without truth.json, every mesh (*.obj,
// *.ply, *.stl, in the order of sort_by_name()) is an object with the poses of truth/poses.txt and the name
// of its file. A mesh with the name `scene` is left out if there are others, since it repeats them.
//
// A recording without truth/ but with scene_gt.json is a scene of BOP: object N is models/obj_N.ply in the
// scene's folder, or one or two folders above, in millimetres; without models it has no truth. cam_R_m2c and
// cam_t_m2c (millimetres) are the pose of an object in the camera frame of an image. Two objects of one
// number in an image are obj_N and obj_N_2, in their order. mask_visib/, if it exists, are the masks.
//
// Throws InputError about the file or folder if truth.json is not as above (other keys are refused), if a
// file does not exist, if two objects have the same name, if truth/ has neither truth.json nor poses.txt with
// a mesh, and if truth/mask exists and is no folder with PNG files.
std::optional<TruthFolder> find_truth(const std::filesystem::path& recording);

// Returns the PNG files of the folder of masks in the order of sort_by_name(); none without that folder.
std::vector<std::filesystem::path> mask_files(const TruthFolder& truth);

// Returns every file of the truth once: truth.json, then for each object its mesh and its poses, then the
// masks.
std::vector<std::filesystem::path> files_of(const TruthFolder& truth);

// Masks of a recording's truth: the pixels at which the truth of a frame holds. A mask is a PNG file of up to
// 8 bits a channel and of the size of the camera's image. The truth holds at the pixels that are neither
// black nor fully transparent. Masks are read when they are first needed, and the last ones are kept, so that
// several threads must not use one object at the same time.
class TruthMasks {
 public:
  // frames: the names of the frames' depth images. A mask belongs to the frame whose name has the same
  // numbers, see numbers_in_name(): mask_0007.png to frame-000007.depth.png. It may have one more number,
  // that of an object: the truth holds where one of the masks of the frame holds. It holds nowhere in a frame
  // without a mask. Throws InputError about a mask whose frame is not clear, and about the folder if the
  // camera has no pixels. Without a folder of masks the truth holds everywhere.
  TruthMasks(const TruthFolder& truth, const std::vector<std::string>& frames,
             const CameraIntrinsics& camera);

  // Returns true if the truth holds at the pixel nearest to the projection of p_C (camera frame), and false
  // for positions outside the image or not in front of the camera. Pre: frame < frame_count. Throws
  // InputError if the mask of the frame cannot be read or does not have the size of the camera's image.
  bool holds_at(std::size_t frame, const Vec3& p_C) const;

 private:
  struct Mask {
    std::size_t frame;
    std::vector<bool> holds;  // pixel (u, v) is element v * width + u
  };
  const std::vector<bool>& mask_of(std::size_t frame) const;
  std::vector<bool> read(std::size_t frame) const;

  std::vector<std::vector<std::filesystem::path>> files_;  // the masks of each frame; empty: no masks
  CameraIntrinsics camera_;
  mutable std::vector<Mask> cache_;  // the masks that were used last, the newest in front
};

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
