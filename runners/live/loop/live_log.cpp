#include "runners/live/loop/live_log.h"

#include <limits>
#include <optional>

#include "analysis/statistics/means_and_extremes.h"
#include "runners/experiment/hand/device_model.h"

namespace remote_touch {

namespace {

// Returns the hand of the simulation that replays this tick: an ideal device, which exerts what it is
// commanded to exert. A run without a slave has none.
std::optional<HandState> hand_state(const LiveTick& tick) {
  if (!tick.slave) return {};
  const DeviceState& device = tick.device;
  const Wrench wrench = exerted({}, device.orientation_W, tick.command);
  return HandState{device.position_W, device.orientation_W, wrench.force_N, wrench.torque_Nm};
}

}  // namespace

void LiveLog::append(const LiveTick& tick, double haptic_rate_hz) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (trace.length() < max_rows) {
    trace.append(static_cast<double>(tick.number) / haptic_rate_hz, tick.device, tick.out,
                 {kUnknown, kUnknown, tick.hash}, hand_state(tick), tick.slave);
    row_step_s.push_back(tick.step_s);
  }
  ++ticks;
  step_s.push_back(tick.step_s);
  if (last_number_ >= 0) {
    interval_s.push_back(tick.since_last_tick_s);
    pieces.push_back(static_cast<double>(last_number_) / haptic_rate_hz, tick.since_last_tick_s);
    missed_ticks += tick.number - last_number_ - 1;
  }
  last_number_ = tick.number;
  if (tick.taken >= 0) {
    latency_s.push_back(tick.latency_s);
    waited_s.push_back(tick.waited_s);
    reversed_frames += tick.taken <= last_taken_ ? 1 : 0;
    last_taken_ = tick.taken, taken_at_ = tick.number;
  }
  exhausted_ticks += tick.out.tool && tick.out.tool->budget_exhausted ? 1 : 0;
  zero_force_ticks += tick.gate == GateState::waiting || tick.gate == GateState::latched ? 1 : 0;
  limited_ticks += tick.is_limited ? 1 : 0;
  contact_ticks +=
      tick.out.contact_count > 0 || tick.out.force_N.norm() > 0 || tick.command.force_N.norm() > 0 ? 1 : 0;
  stale_ticks += static_cast<double>(tick.number - taken_at_) > stale_s * haptic_rate_hz ? 1 : 0;
  max_force_N = max_or_nan(max_force_N, tick.written.force_N.norm());
}

}  // namespace remote_touch
