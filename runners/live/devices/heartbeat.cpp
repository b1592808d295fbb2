#include "runners/live/devices/heartbeat.h"

#include <chrono>

#include "runners/live/timing/real_time.h"
#include "runners/live/timing/steady_clock.h"

namespace remote_touch {

Heartbeat::Heartbeat(HapticDevice& device, double max_s) : device_(device), max_s_(max_s) {
  thread_ = std::thread([this] { watch(); });
}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_one();
  thread_.join();
}

bool Heartbeat::beat(double now_s) noexcept {
  last_s_.store(now_s, std::memory_order_release);
  return !released_.exchange(false, std::memory_order_acq_rel);
}

// A beat may come between the look and letting go: the device is let go then too, and the next beat says so.
void Heartbeat::watch() {
  outrank_the_loop();
  double stalled_at_s = -1;
  std::unique_lock lock(mutex_);
  while (!stopping_.wait_for(lock, std::chrono::duration<double>(max_s_ / 5), [this] { return stop_; })) {
    const double last_s = last_s_.load(std::memory_order_acquire);
    if (last_s < 0 || last_s == stalled_at_s || steady_s() - last_s <= max_s_) continue;
    device_.release();
    released_.store(true, std::memory_order_release);
    stalls_.fetch_add(1, std::memory_order_relaxed);
    stalled_at_s = last_s;  // once a stall
  }
}

}  // namespace remote_touch
