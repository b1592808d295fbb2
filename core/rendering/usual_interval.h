// The interval between the frames of a stream, without its pauses.
#pragma once

#include <algorithm>
#include <limits>

namespace remote_touch {

// The stream goes on after a pause as before, so a pause says nothing about when the next frame comes. An
// interval is a pause as far as it is longer than kLongest times the usual interval before it. This limit
// grows with every interval, so that a stream that becomes slower is believed after a few frames. The first
// interval of a stream is always believed.
class UsualInterval {
 public:
  // Up to two frames in a row may be lost, as with the default max_prediction_s of 0.1 s at 30 Hz.
  static constexpr double kLongest = 3;

  // The interval that ends with the newest frame, s, without the part that is a pause.
  double without_pause(double interval_s) const { return std::min(interval_s, longest_s_); }
  // Ends an interval; one of 0 says nothing about the stream.
  void add(double interval_s) {
    if (interval_s > 0) longest_s_ = kLongest * without_pause(interval_s);
  }

 private:
  double longest_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace remote_touch
