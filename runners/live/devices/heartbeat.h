// A loop that hangs cannot release its device: a separate thread does.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

class Heartbeat {
 public:
  // Checks every fifth of max_s; a device without a beat for that long is released at the next check.
  Heartbeat(HapticDevice& device, double max_s);
  ~Heartbeat();

  // From the loop, at the begin of every tick. The first one starts the watch. False: the device was let go
  // since the last beat.
  bool beat(double now_s) noexcept;
  // After the last beat: no more are expected.
  void rest() noexcept { last_s_.store(-1, std::memory_order_release); }
  int stalls() const { return stalls_.load(std::memory_order_relaxed); }

 private:
  void watch();

  HapticDevice& device_;
  const double max_s_;
  std::atomic<double> last_s_ = -1;  // of the steady clock; -1: none yet
  std::atomic<bool> released_ = false;
  std::atomic<int> stalls_ = 0;
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace remote_touch
