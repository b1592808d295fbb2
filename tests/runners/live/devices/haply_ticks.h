// What the tests of Haply's adapter share: ticks, and faults as text.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

class Ticks : public DeviceCycle {
 public:
  explicit Ticks(std::function<bool()> body) : body_(std::move(body)) {}
  bool tick() noexcept override { return body_(); }

 private:
  std::function<bool()> body_;
};

inline void run_in_a_thread(HapticDevice& device, std::function<bool()> body) {
  Ticks ticks(std::move(body));
  std::thread([&] { device.run(ticks); }).join();
}

inline Wrench force(const Vec3& force_N) {
  return {force_N, Vec3::Zero()};
}

inline void sleep_s(double time_s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(time_s));
}

// What comes true on a busy machine too, in time.
inline bool becomes(const std::function<bool()>& condition) {
  for (int i = 0; i < 400 && !condition(); ++i) sleep_s(5e-3);
  return condition();
}

// Text of the fault, or nothing.
inline std::string told(const DeviceFault& fault) {
  return fault ? fault.what : "";
}

constexpr const char* kLate = "the Haply service does not answer";

// The fault of a tick with this force. On a busy machine the service may be put aside for some milliseconds;
// a tick in which it was late is not counted.
inline std::string tick_fault(HapticDevice& device, DeviceReading& reading, const Vec3& force_N) {
  std::string fault;
  for (int i = 0; i < 50; ++i) {
    fault = told(device.read(reading));
    const std::string written = told(device.write(force(force_N)));
    if (fault.empty()) fault = written;
    if (fault != kLate) break;
  }
  return fault;
}

inline std::string reading_fault(HapticDevice& device, DeviceReading& reading) {
  return tick_fault(device, reading, Vec3::Zero());
}

}  // namespace remote_touch
