// The poses of the camera of a recording, and the agreement of its frames with them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/objects/mesh_object.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

class RecordedTruth;

// The poses of the camera of a recording: at rest, or one for each frame. W is the world frame of the scene
// and B the base frame of the poses: that of the file of poses, or that of the camera if there is none. The
// registration X_WB places B in W.
class CameraPath {
 public:
  // poses: a name in the recording's folder; empty: the camera is at rest in B. It is a file, see
  // mesh_object.h, whose line i is the pose at frame i, or whose poses have stamps. Stamps of the clock of
  // the frames are interpolated at the times of the frames; a frame before the first or after the last of
  // them, by more than 0.02 s, has no pose. Stamps in a recording without stamps belong to the frames in
  // their order. Or it is a folder with one file of 16 numbers for each frame, see pose_files(). Throws
  // InputError if the file cannot be used, has another number of poses than the recording has frames, or has
  // stamps of another clock.
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

// The agreement of the frames of a recording with the poses in its files: frames with each other, by the
// poses of the camera, and measured points with the true objects. Distances are differences of depth in an
// image, medians over its pixels and then over the frames, m. They are compared with those of other meanings
// of the poses, such as the inverse, so that a note can name the likely mistake. Only images are compared;
// other clouds are ignored.
class PoseFit {
 public:
  // Compares a frame with an earlier one. X_WC of the image is not used.
  void add_motion(std::size_t frame, const PointCloud& cloud, const CameraPath& path);
  // Compares a frame with the true objects.
  void add_truth(std::size_t frame, const PointCloud& cloud, const RecordedTruth& truth);

  // Returns a note if the frames fit each other worse with the poses than without, or much better with
  // another meaning of the poses.
  std::vector<Note> motion_notes(const CameraPath& path) const;
  // Returns a note for each object that is nowhere near the measured points, is in the image in none of the
  // frames, or would be much nearer with another meaning of its poses.
  std::vector<Note> truth_notes(const RecordedTruth& truth) const;
  // A cause of the place of an object: "; with the inverse poses cube is 0.2 mm from what the camera
  // measured". Empty: no other meaning of its poses or of the depths does.
  struct Cause {
    std::string text;
    bool is_depth_scale = false;
  };
  // Returns the cause for the first object that has one.
  Cause cause(const RecordedTruth& truth) const;

 private:
  // The gaps of some frames: one list with the poses as they are read, and one for each other meaning.
  using Gaps = std::vector<std::vector<double>>;
  struct ObjectFit {
    Gaps gaps;
    std::size_t frames = 0, frames_in_image = 0, near = 0, measured = 0;  // frames; points
  };
  void set_anchor(std::size_t frame, const PointCloud& cloud, const RigidTransform& X_CW);

  // The frame with which later ones are compared. It is replaced when they have left it.
  struct Anchor {
    std::size_t frame = 0;
    CameraIntrinsics camera;
    std::vector<double> depth_m;
  };
  Anchor anchor_;
  Gaps gaps_;                       // gaps between frames
  std::vector<double> still_gaps_;  // the same, if the camera were at rest
  std::vector<ObjectFit> objects_;
};

}  // namespace remote_touch
