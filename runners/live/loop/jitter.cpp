#include "runners/live/loop/jitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <thread>

#include "analysis/trace/formatted.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

namespace {

class NoDevice final : public HapticDevice {
 public:
  NoDevice(double rate_hz, Clock& clock)
      : HapticDevice(clock, {.name = "no device", .tick_rate_hz = rate_hz}) {}
  DeviceFault read(DeviceReading&) noexcept override { return {}; }
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override {}
};

// Measures lateness against the grid of the loop: it starts when the loop does, and its period is a whole
// number of nanoseconds, see HapticDevice::run(). On another grid a punctual tick could get the number of the
// tick before.
class Watch final : public DeviceCycle {
 public:
  Watch(Jitter& jitter, double duration_s, double rate_hz, const std::atomic<bool>* stop, const Clock& clock)
      : jitter_(jitter),
        period_ns_(std::llround(1e9 / rate_hz)),
        stop_(stop),
        clock_(clock),
        max_(duration_s * rate_hz) {
    jitter_.late_s.reserve(static_cast<std::size_t>(max_) + 1);
  }

  // Call it immediately before the loop begins.
  void start() { start_ns_ = clock_.now_ns(); }

  bool tick() noexcept override {
    const std::int64_t since_ns = clock_.now_ns() - start_ns_;
    const long long number = since_ns / period_ns_;
    if (static_cast<double>(number) >= max_ || (stop_ && *stop_)) return false;
    jitter_.missed += std::max(0LL, number - number_ - 1);
    number_ = number;
    jitter_.late_s.push_back(1e-9 * static_cast<double>(since_ns - number * period_ns_));
    return true;
  }

 private:
  Jitter& jitter_;
  const std::int64_t period_ns_;
  const std::atomic<bool>* const stop_;
  const Clock& clock_;
  const double max_;
  long long number_ = -1;
  std::int64_t start_ns_ = 0;
};

}  // namespace

Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock) {
  Jitter jitter;
  NoDevice device(rate_hz, clock);
  Watch watch(jitter, duration_s, rate_hz, stop, clock);
  std::thread loop([&] {
    jitter.real_time = become_real_time();
    watch.start();
    device.run(watch);
  });
  loop.join();
  return jitter;
}

std::string histogram(const std::vector<double>& late_s) {
  constexpr int kRows = 16, kBar = 50;
  constexpr double kFirst_us = 4;
  std::array<long long, kRows> counts{};
  for (const double late : late_s) {
    const double doubled = std::log2(std::max(1e6 * late, 1e-3) / kFirst_us);  // no NaN
    ++counts[static_cast<std::size_t>(std::clamp(static_cast<int>(std::ceil(doubled)), 0, kRows - 1))];
  }
  const long long max = *std::max_element(counts.begin(), counts.end());  // no NaN
  std::string text;
  for (int i = 0; i < kRows; ++i) {
    const long long count = counts[static_cast<std::size_t>(i)];
    if (count == 0) continue;
    const std::string row =
        formatted("  %8.0f to %8.0f us %10lld %s\n", i == 0 ? 0 : std::ldexp(kFirst_us, i - 1),
                  std::ldexp(kFirst_us, i), count,
                  std::string(static_cast<std::size_t>((kBar * count + max - 1) / max), '#').c_str());
    text += row;
  }
  return text;
}

}  // namespace remote_touch
