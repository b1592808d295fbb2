// The pose of a rigid body as a function of time.
#pragma once

#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

struct StampedPose {
  double time_s = 0;
  RigidTransform X = RigidTransform::Identity();  // frame of the body to its parent frame
};

// Passes through given poses. Between two of them the origin of the body moves on a straight line at constant
// speed, and the body turns about a constant axis, by the shorter way, at constant rate. The bits are the
// same on every machine.
class PosePath {
 public:
  // A body that rests.
  explicit PosePath(const RigidTransform& X);
  // Throws std::invalid_argument unless there is a pose, and the times are finite and strictly increasing.
  explicit PosePath(std::vector<StampedPose> poses);

  // Returns the pose at a time. Before the first time it is the first pose, after the last time the last
  // pose.
  RigidTransform at(double time_s) const;

  // The time of the last pose, from which the body rests.
  double duration_s() const { return poses_.back().time_s; }
  const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  std::vector<StampedPose> poses_;
  std::vector<Vec3> turns_;  // rotation vector from each pose but the last to the next, in the body's frame
};

}  // namespace remote_touch
