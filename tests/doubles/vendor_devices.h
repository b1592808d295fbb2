// The adapters of vendors' libraries with their test doubles, and the steps that their tests share.
#pragma once

#include <functional>
#include <memory>
#include <ostream>
#include <string>

#include "runners/live/devices/haptic_device.h"
#include "tests/doubles/device_double.h"
#include "tests/doubles/installed_double.h"

namespace remote_touch {

struct VendorDevice {
  const char* name;
  const char* uri;  // address of the device on the command line
  const char* double_file;
  const char* variable;  // environment variable that names the library
  const char* library;   // first name that is tried if it is not set
  std::unique_ptr<HapticDevice> (*open)(const std::string& address, Clock& clock);
  Availability (*availability)();

  Eigen::Matrix3d axes;  // maps our axes to the vendor's
  double length_per_m, torque_per_Nm;
  bool has_buttons, drives_itself, has_motors_on_to_read;
  int error, fault_code;  // one of the vendor's codes, and the code in the fault
  int unplugged_code;     // the code in the fault of an unplugged device
};

// GoogleTest prints it in the names of tests.
void PrintTo(const VendorDevice* vendor, std::ostream* out);  // NOLINT(readability-identifier-naming)

extern const VendorDevice kForceDimension, kOpenHaptics, kEntact;

using DoubleInstalled = InstalledDouble<DeviceDouble>;

// Runs the device for that many ticks and one more, which only ends it.
void run_ticks(HapticDevice& device, int ticks, const std::function<void(int)>& tick);

// Nonzero forces and torques that the library received, in order; successive equal ones count once.
std::vector<std::array<double, 6>> sent_forces(const DeviceDouble& device);

// The reading and the fault of one tick after the device has received a force.
struct ReadOnce {
  DeviceReading reading;
  DeviceFault fault;
};
ReadOnce read_once(HapticDevice& device);

}  // namespace remote_touch
