// From the clock of a sensor to that of the host.
#pragma once

namespace remote_touch {

// Arrivals jitter by milliseconds with the bus and the scheduler; the sensor's stamps are even, but count
// from a moment of their own. The difference arrival - stamp is the wanted offset plus a delay that is never
// negative, so the smallest one seen is the nearest to it. What is left in it is the delay that every frame
// has: exposure and transfer cannot be told from this side.
class SensorClock {
 public:
  // When the frame with this stamp was taken, on the clock that tells the arrival: after the frame before,
  // and not after the arrival. Frames come in the order in which they arrived.
  double captured_s(double stamp_s, double arrived_s);

 private:
  bool has_begun_ = false;
  double offset_s_ = 0;
  double stamp_s_ = 0;     // of the frame before
  double captured_s_ = 0;  // likewise
};

}  // namespace remote_touch
