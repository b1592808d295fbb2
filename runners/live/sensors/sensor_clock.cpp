#include "runners/live/sensors/sensor_clock.h"

#include <algorithm>

namespace remote_touch {

namespace {

// How fast two crystals may part. The offset rises with it: else all frames of a sensor whose clock is the
// slower one would look older and older.
constexpr double kDrift = 1e-4;
// No frame is so late: the sensor's clock has stood still.
constexpr double kLatest_s = 1;

}  // namespace

double SensorClock::captured_s(double stamp_s, double arrived_s) {
  const double difference_s = arrived_s - stamp_s, passed_s = stamp_s - stamp_s_;
  // Stamps go back when a sensor is reset or a recording begins anew.
  if (!has_begun_ || passed_s < 0 || difference_s - offset_s_ > kLatest_s) {
    offset_s_ = difference_s;
  } else {
    offset_s_ = std::min(offset_s_ + kDrift * passed_s, difference_s);
  }
  double captured_s = stamp_s + offset_s_;
  // An offset that falls by more than a period would turn two frames round.
  if (has_begun_ && captured_s <= captured_s_) captured_s = captured_s_ + 0.5 * (arrived_s - captured_s_);
  has_begun_ = true;
  stamp_s_ = stamp_s, captured_s_ = captured_s;
  return captured_s;
}

}  // namespace remote_touch
