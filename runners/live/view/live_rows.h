// The ticks of a live run as a page receives them: the columns of a trace, and the wrench written to the
// device.
#pragma once

#include <vector>

#include "analysis/trace/column.h"
#include "analysis/trace/trace.h"
#include "runners/live/devices/device_placement.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

class LiveRows {
 public:
  std::size_t length() const { return trace_.length(); }
  void append(const LiveTick& tick, double haptic_rate_hz, const DevicePlacement& placement);

  // Returns the columns of the trace, whose force and torque are those of the renderer. Adds `device_force`
  // and, for a tool, `device_torque`, which were written to the device after the safety gate. With a slave it
  // adds `commanded_force`, the force before the gate, which may be the slave's and not the renderer's.
  // Adds `tick_interval`, by which a page counts missed deadlines, and `gate`, the state of the gate.
  std::vector<Column> columns() const;

 private:
  Trace trace_;
  std::vector<double> force_N_, torque_Nm_, commanded_N_;  // world frame, three numbers a row
  std::vector<double> interval_s_;
  std::vector<std::int32_t> gate_;
};

}  // namespace remote_touch
