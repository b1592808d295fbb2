#include "scenarios/recordings/camera_path.h"

#include "core/geometry/near_origin.h"
#include "scenarios/meshes/pose_file.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {

CameraPath::CameraPath(const RigidTransform& X_WB, const std::string& poses, const RecordingIndex& recording,
                       const std::filesystem::path& folder)
    : X_WB_(X_WB) {
  if (poses.empty()) return;
  file_ = folder / poses;
  X_CB_ = read_pose_matrices(file_);
  if (X_CB_.size() != recording.frames.size())
    refuse(file_, "has ", X_CB_.size(), " poses: expected ", recording.frames.size(),
           ", one for each frame of the recording");
}

RigidTransform CameraPath::pose(std::size_t source) const {
  if (!moves()) return X_WB_;
  if (!X_CB_[source])
    refuse(file_, "has no pose for frame ", source, ": expected one for every frame that is used");
  const RigidTransform X_WC = X_WB_ * X_CB_[source]->inverse();
  if (!is_near_origin(X_WC.translation()))
    refuse(file_, far_from_origin("frame " + std::to_string(source) + " has its camera"));
  return X_WC;
}

}  // namespace remote_touch
