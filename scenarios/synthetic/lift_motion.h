// Motion of a surface that is lifted, 4.3.2: it waits, rises at constant velocity, accelerates and rests. It
// is a function of time, which a camera only samples.
#pragma once

#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

// 4.3.2 gives the heights at the frames: v_j = v_{j-1} + a / f_c and y_j = y_{j-1} + v_j / f_c. Here they are
// the heights at the updates of the motion, which have a rate of their own. From one to the next it follows
// the parabola with the acceleration a: with the time t from the end of the rise, where it is at y_0,
//   y = y_0 + v_0 t + a t (t + 1 / update_rate_hz) / 2.
// The way from frame to frame grows by a / f_c^2 with each frame, whatever the frame rate f_c. The parabola
// begins one update before the end of the rise, there with a velocity that is a / 2 / update_rate_hz less.
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
  // The same at the time of a frame; exactly the height of an update if both rates are equal.
  double height_of_frame_m(int frame, double frame_rate_hz) const {
    return height_at_update(frame * (settings_.update_rate_hz / frame_rate_hz));
  }
  // Number of frames up to the first at rest.
  int frame_count(double frame_rate_hz) const;

  // The rise and the acceleration, if it has them.
  std::vector<Phase> phases() const;

 private:
  // Times are in updates; 2.5 is in the middle between two.
  double height_at_update(double time) const;
  double on_lines_m(double time) const;
  double risen_m(double updates) const;  // height so long after the beginning of the rise

  const Settings settings_;
  const double rise_begin_, rise_end_, end_;
  std::vector<double> accelerated_m_;  // heights at the updates from the end of the rise on
};

Parameters parameters(LiftMotion::Settings& s);

}  // namespace remote_touch
