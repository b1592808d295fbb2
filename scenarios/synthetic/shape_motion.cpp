#include "scenarios/synthetic/shape_motion.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

// sin(2 pi turns), which is 0 before the first; the same bits on every machine.
double swing(double turns) {
  return turns <= 0 ? 0 : sin_cos(360 * kRadiansPerDegree * (turns - std::floor(turns))).first;
}

}  // namespace

Parameters parameters(ShapeMotion::Settings& s) {
  return {
      {"tilt_deg", &s.tilt_deg, -80, 80, "rotation about z through the origin of the shape, from x to y"},
      {"wait_frames", &s.wait_frames, 0, 100000, "updates at rest before the rise"},
      {"start_depth_m", &s.start_depth_m, -10, 10,
       "the first frame lies this far below y = 0; above it where negative"},
      {"start_velocity_m_per_s", &s.start_velocity_m_per_s, -10, 10,
       "velocity of the rise, v_0 of (4.20); the cloud recedes where negative"},
      {"rise_frames", &s.rise_frames, 0, 100000, "updates at constant velocity before the acceleration"},
      {"acceleration_m_per_s2", &s.acceleration_m_per_s2, -1000, 1000, "acceleration a after the rise"},
      {"acceleration_frames", &s.acceleration_frames, 0, 100000,
       "updates with acceleration; the lift then rests"},
      {"slide_velocity_m_per_s", &s.slide_velocity_m_per_s, -10, 10, "velocity along x, added to the lift"},
      {"shake_amplitude_m", &s.shake_amplitude_m, 0, 1, "amplitude of a vertical sine, added to the lift"},
      {"shake_hz", &s.shake_hz, 0, 1000, "frequency of the shake"},
      {"rock_deg", &s.rock_deg, 0, 45, "amplitude of the rocking about z, added to the tilt"},
      {"rock_hz", &s.rock_hz, 0, 1000, "frequency of the rocking"},
      {"motion_from_s", &s.motion_from_s, 0, 10000, "time at which slide, shake and rocking start"},
  };
}

// The same sums as in moving-lift, so that lifts of both have the same bits.
ShapeMotion::ShapeMotion(const Settings& settings, double frame_rate_hz)
    : settings_(settings), frame_rate_hz_(frame_rate_hz) {
  double velocity = settings.start_velocity_m_per_s;
  height_m_.assign(static_cast<std::size_t>(settings.wait_frames), -settings.start_depth_m);
  for (int j = 0; j <= settings.rise_frames; ++j)
    height_m_.push_back(-settings.start_depth_m + j * (velocity / frame_rate_hz));
  for (int j = 0; j < settings.acceleration_frames; ++j) {
    velocity += settings.acceleration_m_per_s2 / frame_rate_hz;
    height_m_.push_back(height_m_.back() + velocity / frame_rate_hz);
  }
}

double ShapeMotion::lift_m(double time_s) const {
  const double last = static_cast<double>(height_m_.size() - 1);
  const double place = std::clamp(time_s * frame_rate_hz_, 0.0, last);
  const auto j = static_cast<std::size_t>(place);
  if (j + 1 >= height_m_.size()) return height_m_.back();
  return height_m_[j] + (place - static_cast<double>(j)) * (height_m_[j + 1] - height_m_[j]);
}

ShapePose ShapeMotion::moved(double lift_m, double time_s) const {
  const double moving_s = std::max(0.0, time_s - settings_.motion_from_s);
  ShapePose pose;
  pose.x_m = moving_s * settings_.slide_velocity_m_per_s;
  pose.y_m = lift_m;
  if (settings_.shake_amplitude_m > 0)
    pose.y_m += settings_.shake_amplitude_m * swing(moving_s * settings_.shake_hz);
  double rotation_deg = settings_.tilt_deg;
  if (settings_.rock_deg > 0) rotation_deg += settings_.rock_deg * swing(moving_s * settings_.rock_hz);
  if (rotation_deg != 0) std::tie(pose.sine, pose.cosine) = sin_cos(rotation_deg * kRadiansPerDegree);
  return pose;
}

ShapePose ShapeMotion::of_frame(int frame) const {
  const auto j = static_cast<std::size_t>(std::min(frame, lift_frames() - 1));
  return moved(height_m_[j], frame / frame_rate_hz_);
}

ShapePose ShapeMotion::at(double time_s) const {
  return moved(lift_m(time_s), time_s);
}

bool ShapeMotion::ever_rests() const {
  const bool shakes = settings_.shake_amplitude_m > 0 && settings_.shake_hz > 0;
  const bool rocks = settings_.rock_deg > 0 && settings_.rock_hz > 0;
  return settings_.slide_velocity_m_per_s == 0 && !shakes && !rocks;
}

bool ShapeMotion::is_a_lift_alone() const {
  return settings_.tilt_deg == 0 && settings_.rock_deg == 0 && settings_.slide_velocity_m_per_s == 0;
}

}  // namespace remote_touch
