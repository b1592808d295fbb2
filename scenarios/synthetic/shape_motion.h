// Motion of a shape: a lift, 4.3.2, and added to it a slide, a shake and a rotation back and forth.
#pragma once

#include <vector>

#include "core/geometry/vector.h"
#include "core/parameters/parameter.h"
#include "scenarios/synthetic/lift_motion.h"

namespace remote_touch {

// The pose of a shape's frame S in the world: origin at (x, y, 0), rotated about z (from x to y).
struct ShapePose {
  double x_m = 0, y_m = 0;
  double sine = 0, cosine = 1;

  Vec3 to_W(const Vec3& p_S) const {
    return {cosine * p_S.x() - sine * p_S.y() + x_m, sine * p_S.x() + cosine * p_S.y() + y_m, p_S.z()};
  }
  Vec3 direction_to_W(const Vec3& direction_S) const {
    return {cosine * direction_S.x() - sine * direction_S.y(),
            sine * direction_S.x() + cosine * direction_S.y(), direction_S.z()};
  }
  Vec3 to_S(const Vec3& p_W) const {
    const double x = p_W.x() - x_m, y = p_W.y() - y_m;
    return {cosine * x + sine * y, cosine * y - sine * x, p_W.z()};
  }
};

class ShapeMotion {
 public:
  struct Settings {
    double tilt_deg = 0;
    LiftMotion::Settings lift;
    // Sines begin with phase 0.
    double slide_velocity_m_per_s = 0;
    double shake_amplitude_m = 0, shake_hz = 5;
    double rock_deg = 0, rock_hz = 1;
    double motion_from_s = 0;
  };

  ShapeMotion(const Settings& settings, double frame_rate_hz);

  ShapePose of_frame(int frame) const;
  ShapePose at(double time_s) const;

  // Number of frames up to and including the first one at rest after the lift.
  int lift_frames() const { return lift_.frame_count(frame_rate_hz_); }
  // The phases of the lift, then one phase for all other motion, which never ends.
  std::vector<Phase> phases() const;
  bool ever_rests() const;
  bool moves_vertically_only() const;  // neither rotated nor moved along x

 private:
  ShapePose moved(double lift_m, double time_s) const;

  const Settings settings_;
  const double frame_rate_hz_;
  const LiftMotion lift_;
};

Parameters parameters(ShapeMotion::Settings& s);

}  // namespace remote_touch
