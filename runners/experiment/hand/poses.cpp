#include "runners/experiment/hand/poses.h"

#include <algorithm>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

constexpr std::size_t kColumns = 7;
constexpr double kHalfRotation_deg = 179.99;

DeviceState pose(const double* row) {
  return {{row[0], row[1], row[2]}, rotation(kRadiansPerDegree * Vec3(row[3], row[4], row[5]))};
}

Vec3 rotation_to(const DeviceState& from, const DeviceState& to) {
  return rotation_vector(to.orientation_W * from.orientation_W.conjugate());
}

}  // namespace

Parameters parameters(Poses::Settings& s) {
  return {
      {"poses", Rows{{"x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg", "duration_s"}, &s.poses}, -1000,
       1000,
       "poses: position, rotation vector (axis times angle, world frame) and duration of the motion to it; 0 jumps. The first pose is the start; its duration is ignored. A motion rotates by less than 180 degrees, in the shorter direction; for more, insert a pose"}};
}

std::string validate(const Poses::Settings& s) {
  if (s.poses.empty()) return "poses = []: expected one row or more";
  for (std::size_t i = 0; i + kColumns <= s.poses.size(); i += kColumns) {
    const double* const row = s.poses.data() + i;
    if (row[6] < 0) return "poses: a duration of " + std::to_string(row[6]) + ": expected 0 or more";
    if (i > 0 && row[6] > 0 &&
        rotation_to(pose(row - kColumns), pose(row)).norm() > kHalfRotation_deg * kRadiansPerDegree)
      return "poses: row " + std::to_string(i / kColumns) +
             " is rotated by 180 degrees from the row before: expected less, because the direction of rotation is "
             "ambiguous";
  }
  return "";
}

Poses::Poses(const Settings& settings, const Scenario&)
    : poses_{pose(settings.poses.data())}, arrival_s_{0}, rotation_W_{Vec3::Zero()} {
  for (std::size_t i = kColumns; i + kColumns <= settings.poses.size(); i += kColumns) {
    const double* const row = settings.poses.data() + i;
    const DeviceState next = pose(row);
    rotation_W_.push_back(rotation_to(poses_.back(), next));
    arrival_s_.push_back(arrival_s_.back() + row[6]);
    poses_.push_back(next);
  }
}

DeviceState Poses::at(double time_s) const {
  // The first pose that is reached after time_s. At the time of a jump the device is at the end of the jump.
  const auto next = std::upper_bound(arrival_s_.begin(), arrival_s_.end(), time_s);
  if (next == arrival_s_.end()) return poses_.back();
  if (next == arrival_s_.begin()) return poses_.front();
  const auto i = static_cast<std::size_t>(next - arrival_s_.begin());
  const double fraction = (time_s - arrival_s_[i - 1]) / (arrival_s_[i] - arrival_s_[i - 1]);
  const DeviceState &from = poses_[i - 1], &to = poses_[i];
  return {from.position_W + fraction * (to.position_W - from.position_W),
          (rotation(fraction * rotation_W_[i]) * from.orientation_W).normalized()};
}

}  // namespace remote_touch
