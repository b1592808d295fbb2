#include "runners/live/loop/jitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <thread>

#include "core/parameters/parameter.h"
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

}  // namespace

// Lateness is measured against the grid of the loop: it starts when the loop does, and its period is a whole
// number of nanoseconds, see HapticDevice::run(). On another grid a punctual tick could get the number of the
// tick before.
Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock) {
  Jitter jitter;
  const double max = duration_s * rate_hz;
  jitter.late_s.reserve(static_cast<std::size_t>(max) + 1);
  const std::int64_t period_ns = std::llround(1e9 / rate_hz);
  NoDevice device(rate_hz, clock);
  std::thread loop([&] {
    jitter.real_time = become_real_time();
    long long last = -1;
    const std::int64_t start_ns = clock.now_ns();
    device.run([&] {
      const std::int64_t since_ns = clock.now_ns() - start_ns;
      const long long number = since_ns / period_ns;
      if (static_cast<double>(number) >= max || (stop && *stop)) return false;
      jitter.missed += std::max(0LL, number - last - 1);
      last = number;
      jitter.late_s.push_back(1e-9 * static_cast<double>(since_ns - number * period_ns));
      return true;
    });
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
