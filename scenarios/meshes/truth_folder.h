// The truth of a recording, in its folder truth/ or in the layout of BOP: which meshes are the true surfaces,
// and their poses.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

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

}  // namespace remote_touch
