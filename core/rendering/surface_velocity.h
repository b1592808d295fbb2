// Estimate of the point cloud velocity, 4.2.5: the speed of the surface along the proxy's normal, positive
// towards the proxy.
#pragma once

#include <algorithm>
#include <limits>

#include "core/points/vector.h"

namespace remote_touch {

// The interval between the frames of a stream, without pauses of the stream. A stream continues at its former
// rate after a pause, so a pause does not predict when the next frame comes. The part of an interval above a
// limit counts as a pause. The limit is kMaxRatio times the previous interval without its own pause. It grows
// with each longer interval, so a stream that becomes slower is accepted after a few frames. The first
// interval of a stream has no limit.
class UsualInterval {
 public:
  // Two frames in a row may be lost without a pause, as with the default max_prediction_s of 0.1 s at 30 Hz.
  static constexpr double kMaxRatio = 3;

  // Returns the interval that ends with the newest frame, s, without the part that is a pause.
  double without_pause(double interval_s) const { return std::min(interval_s, longest_s_); }
  // Adds an interval that has ended. An interval of 0 is ignored.
  void add(double interval_s) {
    if (interval_s > 0) longest_s_ = kMaxRatio * without_pause(interval_s);
  }

 private:
  double longest_s_ = std::numeric_limits<double>::infinity();
};

class SurfaceVelocity {
 public:
  // max_interval_s bounds how far ahead (4.3) extrapolates when frames are missing.
  explicit SurfaceVelocity(double max_interval_s)
      : max_interval_s_(max_interval_s), horizon_s_(max_interval_s) {}

  // Processes a new frame, with the normal estimated just before it. Returns the correction s_j of (4.3), to
  // be added to the proxy. The interval is the time between the captures of the two frames: 1/f_c for a
  // steady stream. Frames that follow each other without a step between them count as one.
  Vec3 on_frame(double captured_s, const Vec3& normal);
  // Adds the growth of a forbidden region under the proxy in the newest frame, m. on_step() subtracts it,
  // because it is no motion of the cloud. Call it between on_frame() and on_step().
  void on_growth(double growth_m) { growth_m_ += growth_m; }
  // Corrects the estimate by the first proxy step after a frame, (4.13); later steps change nothing. It may
  // be a step of any state: a free step back to the surface shows that the estimate was too high. The
  // estimate is never negative and never reset.
  void on_step(const Vec3& step);

  // Replaces on_frame() and on_step() if the motion is measured by other means. The velocity along the normal
  // may then be negative.
  void on_measured(double captured_s, double velocity_m_per_s, const Vec3& normal);

  double m_per_s() const { return velocity_m_per_s_; }
  // Returns v_hat as a vector along the normal of the last frame.
  Vec3 vector() const { return velocity_m_per_s_ * normal_; }
  // Returns the time after a frame during which v_hat may be used, s: the larger of max_interval_s and the
  // newest interval between frames without its pause.
  double horizon_s() const { return horizon_s_; }

 private:
  void set_horizon();

  double max_interval_s_;
  double horizon_s_;
  double velocity_m_per_s_ = 0;  // v_0 = 0
  double captured_s_ = 0;
  double interval_s_ = 0;  // time since the frame before the last step; 0 before the second frame
  UsualInterval usual_interval_;
  double frame_correction_m_ = 0;  // displacement of the proxy along the normal in that time
  double growth_m_ = 0;            // growth of regions in that time
  Vec3 normal_ = Vec3::Zero();
  bool has_frame_ = false;
  bool awaits_step_ = false;
};

}  // namespace remote_touch
