// The interface of every depth camera.
#pragma once

#include <string>

#include "runners/live/timing/clock.h"
#include "runners/sessions/sensor_frame.h"

namespace remote_touch {

enum class SensorState { frame, waiting, ended, failed };

// Used from one thread. The constructor opens the sensor and throws InputError with what is missing and what
// would help.
class DepthSource {
 public:
  virtual ~DepthSource() = default;

  virtual const SensorView& view() const = 0;
  // Waits for the next frame, timeout_s at most. Reuses the memory of the given frame. Throws InputError,
  // which names the frame, for one that cannot be used: the run then ends. A camera that was lost has
  // `failed` instead: its last frame remains in use.
  virtual SensorState next(SensorFrame& frame, double timeout_s) = 0;
  // Why it failed, in one line.
  virtual std::string failure() const { return {}; }
};

}  // namespace remote_touch
