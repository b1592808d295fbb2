// The ticks of a live run as a page gets them: the columns of a trace, and what reached the device.
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

  // The columns of the trace, whose force and torque the renderer commands; device_force and, for a tool,
  // device_torque, which the safety gate sent to the device; and gate, the state of the gate.
  std::vector<Column> columns() const;

 private:
  Trace trace_;
  std::vector<double> force_N_, torque_Nm_;  // world frame, three numbers a row
  std::vector<std::int32_t> gate_;
};

}  // namespace remote_touch
