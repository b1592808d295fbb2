// The poses of the camera of a recording: at rest, or one for each frame.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vector.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// W is the world frame of the scene and B the base frame of the poses: that of the file of poses, or that of
// the camera if there is none. The registration X_WB places B in W.
class CameraPath {
 public:
  // poses: name of a file in the recording's folder, see pose_file.h; line i is the transform from B to the
  // camera at frame i. Empty: the camera is at rest in B. Throws InputError if the file cannot be used or has
  // another number of poses than the recording has frames.
  CameraPath(const RigidTransform& X_WB, const std::string& poses, const RecordingIndex& recording,
             const std::filesystem::path& folder);

  bool moves() const { return !X_CB_.empty(); }
  // Returns the pose of the camera at a frame of the recording. Throws InputError if it is not known.
  RigidTransform pose(std::size_t source) const;

 private:
  RigidTransform X_WB_;
  std::filesystem::path file_;
  std::vector<std::optional<RigidTransform>> X_CB_;
};

}  // namespace remote_touch
