// Conversion of times from the clock of a sensor to that of the host.
#pragma once

namespace remote_touch {

// Arrivals jitter by milliseconds with the bus and the scheduler; the sensor's stamps are regular, but have
// their own origin. The difference arrival - stamp is the wanted offset plus a delay that is never negative,
// so the smallest difference is nearest to the offset. It still contains the delay common to all frames:
// exposure and transfer cannot be measured on the host.
class SensorClock {
 public:
  // Returns the time at which the frame with this stamp was captured, on the clock of the arrival: later than
  // the frame before, and not later than the arrival. pre: called in the order of arrival.
  double captured_s(double stamp_s, double arrived_s);

 private:
  bool has_begun_ = false;
  double offset_s_ = 0;
  double stamp_s_ = 0;     // time stamp of the frame before
  double captured_s_ = 0;  // time of capture of the frame before
};

}  // namespace remote_touch
