// Motion of a surface that is lifted, 4.3.2: it waits, rises at constant velocity, accelerates and rests. It
// is a function of time, which a camera samples at its frames.
#pragma once

#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// 4.3.2 gives the heights at the frames: v_j = v_{j-1} + a / f_c and y_j = y_{j-1} + v_j / f_c. This class
// uses them as the heights at the updates of the motion, which have a rate of their own. The motion between
// two updates is linear, or it follows the parabola with the acceleration a. With the time t since the end of
// the rise and the height y_0 there, the parabola is
//   y = y_0 + v_0 t + a t (t + 1 / update_rate_hz) / 2.
// The displacement from frame to frame then grows by a / f_c^2 with each frame, for any frame rate f_c. The
// parabola begins one update before the end of the rise. The velocity drops there by a / (2 update_rate_hz).
class LiftMotion {
 public:
  enum class BetweenUpdates { parabola, line };
  struct Settings {
    double wait_s = 0;
    double start_depth_m = 0;
    double start_velocity_m_per_s = 0;
    double rise_s = 0;
    double acceleration_m_per_s2 = 0;
    double acceleration_s = 0;
    double update_rate_hz = 30;
    BetweenUpdates between_updates = BetweenUpdates::parabola;
  };

  explicit LiftMotion(const Settings& settings);

  double height_m(double time_s) const { return height_at_update(time_s * settings_.update_rate_hz); }
  // Height at the time of a frame. It is exactly the height of an update if both rates are equal.
  double height_of_frame_m(int frame, double frame_rate_hz) const {
    return height_at_update(frame * (settings_.update_rate_hz / frame_rate_hz));
  }
  // Number of frames up to and including the first one at rest after the motion.
  int frame_count(double frame_rate_hz) const;

  // Returns the rise and the acceleration, if the motion has them.
  std::vector<Phase> phases() const;

 private:
  // Times are in updates: 2.5 is in the middle between updates 2 and 3.
  double height_at_update(double time) const;
  double on_lines_m(double time) const;
  double risen_m(double updates) const;  // height at this time after the beginning of the rise

  const Settings settings_;
  const double rise_begin_, rise_end_, end_;
  std::vector<double> accelerated_m_;  // heights at the updates from the end of the rise on
};

Parameters parameters(LiftMotion::Settings& s);

}  // namespace remote_touch
