#include "runners/live/sensors/sensor_clock.h"

#include <algorithm>

namespace remote_touch {

namespace {

// Rate at which two crystals may drift apart. The offset rises at this rate. Otherwise the frames of a sensor
// with the slower clock would appear older and older.
constexpr double kDrift = 1e-4;
// No frame arrives later than this after its capture. If one seems to, the sensor's clock has stood still.
constexpr double kLatest_s = 1;

}  // namespace

double SensorClock::captured_s(double stamp_s, double arrived_s) {
  const double difference_s = arrived_s - stamp_s, passed_s = stamp_s - stamp_s_;
  // Time stamps go back if a sensor is reset or a recording starts again.
  if (!has_begun_ || passed_s < 0 || difference_s - offset_s_ > kLatest_s) {
    offset_s_ = difference_s;
  } else {
    offset_s_ = std::min(offset_s_ + kDrift * passed_s, difference_s);
  }
  double captured_s = stamp_s + offset_s_;
  // An offset that falls by more than a period would reverse the order of two frames.
  if (has_begun_ && captured_s <= captured_s_) captured_s = captured_s_ + 0.5 * (arrived_s - captured_s_);
  has_begun_ = true;
  stamp_s_ = stamp_s, captured_s_ = captured_s;
  return captured_s;
}

}  // namespace remote_touch
