#include "scenarios/synthetic/shape_motion.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

// Returns sin(2 pi turns), or 0 before the first turn; the same bits on every machine.
double swing(double turns) {
  return turns <= 0 ? 0 : sin_cos(360 * kRadiansPerDegree * (turns - std::floor(turns))).first;
}

}  // namespace

Parameters parameters(ShapeMotion::Settings& s) {
  const Parameters tilt = {
      {"tilt_deg", &s.tilt_deg, -80, 80, "rotation about z through the origin of the shape, from x to y"}};
  const Parameters more = {
      {"slide_velocity_m_per_s", &s.slide_velocity_m_per_s, -10, 10, "velocity along x, added to the lift"},
      {"shake_amplitude_m", &s.shake_amplitude_m, 0, 1, "amplitude of a vertical sine, added to the lift"},
      {"shake_hz", &s.shake_hz, 0, 1000, "frequency of the shake"},
      {"rock_deg", &s.rock_deg, 0, 45, "amplitude of the rocking about z, added to the tilt"},
      {"rock_hz", &s.rock_hz, 0, 1000, "frequency of the rocking"},
      {"motion_from_s", &s.motion_from_s, 0, 10000, "time at which slide, shake and rocking start"},
  };
  return appended(appended(tilt, parameters(s.lift)), more);
}

ShapeMotion::ShapeMotion(const Settings& settings, double frame_rate_hz)
    : settings_(settings), frame_rate_hz_(frame_rate_hz), lift_(settings.lift) {}

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
  return moved(lift_.height_of_frame_m(frame, frame_rate_hz_), frame / frame_rate_hz_);
}

ShapePose ShapeMotion::at(double time_s) const {
  return moved(lift_.height_m(time_s), time_s);
}

std::vector<Phase> ShapeMotion::phases() const {
  std::vector<Phase> list = lift_.phases();
  if (!ever_rests()) list.push_back({"the slide, shake or rocking", settings_.motion_from_s});
  return list;
}

bool ShapeMotion::ever_rests() const {
  const bool shakes = settings_.shake_amplitude_m > 0 && settings_.shake_hz > 0;
  const bool rocks = settings_.rock_deg > 0 && settings_.rock_hz > 0;
  return settings_.slide_velocity_m_per_s == 0 && !shakes && !rocks;
}

bool ShapeMotion::moves_vertically_only() const {
  return settings_.tilt_deg == 0 && settings_.rock_deg == 0 && settings_.slide_velocity_m_per_s == 0;
}

}  // namespace remote_touch
