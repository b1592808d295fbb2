// The poses of the camera of a recording: at rest, or one for each frame.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/vector.h"
#include "scenarios/meshes/pose_file.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// W is the world frame of the scene and B the base frame of the poses: that of the file of poses, or that of
// the camera if there is none. The registration X_WB places B in W.
class CameraPath {
 public:
  // poses: a name in the recording's folder; empty: the camera is at rest in B. It is a file, see
  // pose_file.h, whose line i is the pose at frame i, or whose poses have stamps. Stamps of the clock of the
  // frames are interpolated at the times of the frames; a frame before the first or after the last of them,
  // by more than 0.02 s, has no pose. Stamps in a recording without stamps belong to the frames in their
  // order. Or it is a folder with one file of 16 numbers for each frame, see pose_files(). Throws InputError
  // if the file cannot be used, has another number of poses than the recording has frames, or has stamps of
  // another clock.
  CameraPath(const RigidTransform& X_WB, const std::string& poses, PoseDirection direction,
             const RecordingIndex& recording, const std::filesystem::path& folder);

  bool moves() const { return !poses_.poses.empty(); }
  // Returns the pose of the camera at a frame of the recording. Throws InputError if it is not known.
  RigidTransform pose(std::size_t source) const;
  // Returns the pose in B, if it is known, as it would be with another meaning of the file's numbers. Null:
  // as they are read.
  std::optional<RigidTransform> pose_if(const OtherMeaning* meaning, std::size_t source) const;

  // "camera_poses: poses.txt, 70 poses over 2.3 s at 30 Hz, ...", or empty.
  std::string text() const;
  // Notes on poses that are improbable.
  std::vector<Note> notes() const;
  const PoseFile& file() const { return poses_; }

 private:
  std::vector<StampedPose> stamped() const;

  RigidTransform X_WB_;
  PoseDirection direction_;
  PoseFile poses_;              // one for each frame
  std::vector<double> time_s_;  // time of each frame
};

// Returns the file of each depth image, or an empty path: the .txt file of the folder whose name has the same
// numbers. Throws InputError if two files have the same numbers, or none has those of a depth image.
std::vector<std::filesystem::path> pose_files(const std::filesystem::path& folder,
                                              const RecordingIndex& recording);

}  // namespace remote_touch
