#include "scenarios/meshes/pose_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

void require_increasing_times(const std::vector<StampedPose>& poses) {
  if (poses.empty()) throw std::invalid_argument("pose path: no pose: expected one or more");
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!std::isfinite(poses[i].time_s) || (i > 0 && !(poses[i].time_s > poses[i - 1].time_s)))
      throw std::invalid_argument("pose path: time of pose " + std::to_string(i) +
                                  ": expected finite times, each above the one before");
}

}  // namespace

PosePath::PosePath(const RigidTransform& X) : PosePath(std::vector<StampedPose>{{0, X}}) {}

PosePath::PosePath(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  require_increasing_times(poses_);
  for (std::size_t i = 0; i + 1 < poses_.size(); ++i) {
    const Eigen::Matrix3d R = poses_[i].X.linear().transpose() * poses_[i + 1].X.linear();
    turns_.push_back(rotation_vector(Eigen::Quaterniond(R).normalized()));
  }
}

RigidTransform PosePath::at(double time_s) const {
  const auto is_earlier = [](double t, const StampedPose& pose) { return t < pose.time_s; };
  const auto next = std::upper_bound(poses_.begin(), poses_.end(), time_s, is_earlier);
  if (next == poses_.begin()) return poses_.front().X;
  const StampedPose& last = *(next - 1);
  if (next == poses_.end()) return last.X;
  const double share = (time_s - last.time_s) / (next->time_s - last.time_s);
  const Vec3& turn = turns_[static_cast<std::size_t>(next - poses_.begin()) - 1];
  RigidTransform X = RigidTransform::Identity();
  X.linear() = last.X.linear() * rotation(share * turn).toRotationMatrix();
  X.translation() = last.X.translation() + share * (next->X.translation() - last.X.translation());
  return X;
}

}  // namespace remote_touch
