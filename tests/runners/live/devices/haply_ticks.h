// Shared by the tests of Haply's adapter: ticks, and faults as text.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "runners/live/devices/haptic_device.h"
#include "tests/doubles/simulated_haply.h"

namespace remote_touch {

inline Wrench force(const Vec3& force_N) {
  return {force_N, Vec3::Zero()};
}

// Text of the fault, or nothing.
inline std::string fault_text(const DeviceFault& fault) {
  return fault ? fault.what : "";
}

constexpr const char* kLate = "the Haply service does not answer";

// The adapter at a service on a simulated clock.
class SimulatedHaplyTest : public testing::Test {
 protected:
  // Runs a tick of one millisecond. Returns its first fault; empty if there was none.
  std::string tick(HapticDevice& device, const Vec3& force_N = Vec3::Zero()) {
    const std::int64_t end_ns = clock_.now_ns() + ms(1);
    const std::string read = fault_text(device.read(reading_)),
                      written = fault_text(device.write(force(force_N)));
    clock_.sleep_until_ns(end_ns);
    return read.empty() ? written : read;
  }
  double newest_force_N() const { return service_.sent().back().command.force_N.norm(); }

  SimulatedClock clock_;
  SimulatedHaply service_{clock_};
  DeviceReading reading_;
};

}  // namespace remote_touch
