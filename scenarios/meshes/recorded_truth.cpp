#include "scenarios/meshes/recorded_truth.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "scenarios/meshes/checked_object.h"
#include "scenarios/meshes/pose_file.h"
#include "scenarios/text_files/file_order.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

using Poses = std::vector<std::optional<RigidTransform>>;

constexpr std::size_t kSamples = 400;  // number of points on each object

MeshObject object_of(const TruthObjectFiles& files, const MeshReader& read_mesh) {
  TriangleMesh mesh = read_mesh(files.mesh);
  if (files.metres_per_unit != 1)
    for (Vec3& vertex : mesh.vertices) vertex *= files.metres_per_unit;
  return checked_object(files.name, mesh, files.closed,
                        {files.mesh.string(), ", or \"closed\": false in truth.json"});
}

Poses poses_by_number(const TruthObjectFiles& object, const std::vector<std::string>& frames) {
  Poses poses(frames.size());
  for (const auto& [numbers, frame] : frames_by_numbers(object.poses, frames))
    if (const auto found = object.X_CO.find(numbers.back()); found != object.X_CO.end())
      poses[frame] = found->second;
  return poses;
}

Poses poses_in_file(const std::filesystem::path& file, std::size_t frame_count) {
  Poses poses = read_poses(file, PoseLines::of_frames).poses;
  if (poses.size() != frame_count)
    refuse(file, poses.size(), " poses for ", frame_count, " frames: expected one line for each frame");
  return poses;
}

// Returns the poses of all objects, those of one frame side by side.
Poses poses_of(const TruthFolder& folder, const std::vector<std::string>& frames) {
  const std::size_t count = folder.objects.size();
  Poses poses(frames.size() * count);
  for (std::size_t i = 0; i < count; ++i) {
    const TruthObjectFiles& object = folder.objects[i];
    const Poses of_object =
        object.X_CO.empty() ? poses_in_file(object.poses, frames.size()) : poses_by_number(object, frames);
    for (std::size_t frame = 0; frame < frames.size(); ++frame) poses[frame * count + i] = of_object[frame];
  }
  return poses;
}

}  // namespace

RecordedTruth::RecordedTruth(const TruthFolder& folder, const std::vector<std::string>& frames,
                             double reach_m, const MeshReader& read_mesh, const CameraIntrinsics& camera)
    : poses_file_(folder.objects.front().poses),
      X_CO_(poses_of(folder, frames)),
      masks_(folder, frames, camera),
      reach_m_(reach_m),
      uncertainty_m_(folder.uncertainty_m) {
  for (const TruthObjectFiles& files : folder.objects) {
    objects_.push_back(object_of(files, read_mesh));
    samples_.push_back(surface_samples(*objects_.back().shape, kSamples));
    name_ += (name_.empty() ? folder.name + " (" : ", ") + files.name;
  }
  name_ += ")";
  if (std::none_of(X_CO_.begin(), X_CO_.end(), [](const auto& X) { return X.has_value(); }))
    refuse(poses_file_, "has no known pose: expected the pose of an object in a frame or more");
}

void RecordedTruth::require_view(const CameraIntrinsics& camera, const std::string& cause) const {
  if (camera.pixels() == 0) return;
  std::size_t first = X_CO_.size();  // the first known pose
  for (std::size_t i = X_CO_.size(); i-- > 0;) {
    if (!X_CO_[i]) continue;
    if (count_in_image(samples_[i % objects_.size()], *X_CO_[i], camera) > 0) return;
    first = i;
  }
  char place[128];
  const Vec3& p_C = X_CO_[first]->translation();
  std::snprintf(place, sizeof place, " is at x %.3g, y %.3g, z %.3g m in frame %zu", p_C.x(), p_C.y(),
                p_C.z(), first / objects_.size());
  refuse(poses_file_, "no object is in the image of any frame: ", objects_[first % objects_.size()].name,
         place, cause, ": expected object frame to camera frame, x right, y down, z forward, metres");
}

NearestOnObjects RecordedTruth::at(std::size_t frame, const Vec3& p_C) const {
  if (!p_C.allFinite() || !masks_.holds_at(frame, p_C)) return {};
  return nearest_on_objects(objects_, poses(frame), p_C, reach_m_);
}

}  // namespace remote_touch
