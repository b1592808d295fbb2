// The agreement of the frames of a recording with the poses in its files: frames with each other, by the
// poses of the camera, and measured points with the true objects.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/recordings/camera_path.h"

namespace remote_touch {

class RecordedTruth;

// Distances are differences of depth in an image, medians over its pixels and then over the frames, m. They
// are compared with those of other meanings of the poses, such as the inverse, so that a note can name the
// likely mistake. Only images are compared; other clouds are ignored.
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
