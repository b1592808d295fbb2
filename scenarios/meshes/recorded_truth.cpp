#include "scenarios/meshes/recorded_truth.h"

#include <string>
#include <utility>

#include "scenarios/meshes/checked_object.h"
#include "scenarios/meshes/pose_file.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

MeshObject object_of(const TruthObjectFiles& files, const MeshReader& read_mesh) {
  return checked_object(files.name, read_mesh(files.mesh), files.closed,
                        {files.mesh.string(), ", or \"closed\": false in truth.json"});
}

// Returns the poses of all objects, those of one frame side by side.
std::vector<std::optional<RigidTransform>> poses_of(const TruthFolder& folder, std::size_t frame_count) {
  const std::size_t count = folder.objects.size();
  std::vector<std::optional<RigidTransform>> poses(frame_count * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto of_object = read_pose_matrices(folder.objects[i].poses);
    if (of_object.size() != frame_count)
      refuse(folder.objects[i].poses, of_object.size(), " poses for ", frame_count,
             " frames: expected one line for each frame");
    for (std::size_t frame = 0; frame < frame_count; ++frame) poses[frame * count + i] = of_object[frame];
  }
  return poses;
}

}  // namespace

RecordedTruth::RecordedTruth(const TruthFolder& folder, std::size_t frame_count, double reach_m,
                             const MeshReader& read_mesh, const CameraIntrinsics& camera)
    : X_CO_(poses_of(folder, frame_count)),
      masks_(folder, frame_count, camera),
      reach_m_(reach_m),
      uncertainty_m_(folder.uncertainty_m) {
  for (const TruthObjectFiles& files : folder.objects) objects_.push_back(object_of(files, read_mesh));
}

NearestOnObjects RecordedTruth::at(std::size_t frame, const Vec3& p_C) const {
  if (!p_C.allFinite() || !masks_.holds_at(frame, p_C)) return {};
  return nearest_on_objects(objects_, poses(frame), p_C, reach_m_);
}

}  // namespace remote_touch
