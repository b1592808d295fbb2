// The interval between the frames of a stream, without pauses of the stream.
#pragma once

#include <algorithm>
#include <limits>

namespace remote_touch {

// A stream continues at its former rate after a pause, so a pause does not predict when the next frame comes.
// The part of an interval above a limit counts as a pause. The limit is kMaxRatio times the previous interval
// without its own pause. It grows with each longer interval, so a stream that becomes slower is accepted
// after a few frames. The first interval of a stream has no limit.
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

}  // namespace remote_touch
