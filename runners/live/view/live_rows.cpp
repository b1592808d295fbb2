#include "runners/live/view/live_rows.h"

#include <limits>

namespace remote_touch {

void LiveRows::append(const LiveTick& tick, double haptic_rate_hz, const DevicePlacement& placement) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  trace_.append(static_cast<double>(tick.number) / haptic_rate_hz, tick.device, tick.out,
                {kUnknown, kUnknown, tick.hash}, {}, tick.slave);
  const Wrench written_W = placement.in_world(tick.written);
  force_N_.insert(force_N_.end(), written_W.force_N.begin(), written_W.force_N.end());
  torque_Nm_.insert(torque_Nm_.end(), written_W.torque_Nm.begin(), written_W.torque_Nm.end());
  commanded_N_.insert(commanded_N_.end(), tick.command.force_N.begin(), tick.command.force_N.end());
  interval_s_.push_back(tick.since_last_tick_s);
  gate_.push_back(static_cast<std::int32_t>(tick.gate));
}

std::vector<Column> LiveRows::columns() const {
  std::vector<Column> list = trace_.columns();
  list.push_back({"device_force", "N", "force that is sent to the device, world frame", force_N_, 3, {}});
  if (trace_.has_slave())
    list.push_back({"commanded_force",
                    "N",
                    "force that the device is to exert, before the safety gate, world frame",
                    commanded_N_,
                    3,
                    {}});
  if (trace_.has_tool())
    list.push_back(
        {"device_torque", "N m", "torque that is sent to the device, world frame", torque_Nm_, 3, {}});
  list.push_back({"tick_interval", "s", "time since the start of the tick before", interval_s_, 1, {}});
  list.push_back(
      {"gate", "1", "state of the safety gate", gate_, 1, {"waiting", "ramping", "engaged", "latched"}});
  return list;
}

}  // namespace remote_touch
