// The interface of every depth camera.
#pragma once

#include <cstdint>
#include <string>

#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/live/devices/clock.h"

namespace remote_touch {

enum class SensorState { frame, waiting, ended, failed };

// Only one thread may use it. The constructor opens the sensor; it throws InputError, with what is missing
// and what would help.
class DepthSource {
 public:
  virtual ~DepthSource() = default;

  const SensorView& view() const { return view_; }
  // Called at most once, before the first next(): the run begins at start_ns, a time of the clock. A
  // simulated camera counts its time from there; a real one ignores it.
  virtual void start_at([[maybe_unused]] std::int64_t start_ns) {}
  // Waits for the next frame, timeout_s at most. Reuses the memory of the given frame. Throws InputError,
  // which names the frame, if a frame cannot be used: the run then ends. If the camera was lost, it returns
  // `failed` instead: the last frame remains in use.
  virtual SensorState next(SensorFrame& frame, double timeout_s) = 0;
  // Returns the reason why it failed, in one line.
  const std::string& failure() const { return failure_; }

 protected:
  SensorView view_;  // fixed when the constructor of the sensor ends
  std::string failure_;
};

}  // namespace remote_touch
