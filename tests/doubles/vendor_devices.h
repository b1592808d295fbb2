// The adapters of vendors' libraries with their test doubles, and the steps that their tests share.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runners/live/devices/device_table.h"
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

// Returns the axes of a vendor with x towards the user, y right and z up. The rows are these axes in our
// frame.
inline Eigen::Matrix3d user_right_up() {
  return (Eigen::Matrix3d() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
}

inline const VendorDevice kForceDimension{.name = "force_dimension",
                                          .uri = "fd:0",
                                          .double_file = REMOTE_TOUCH_DOUBLE_DEVICES,
                                          .variable = "REMOTE_TOUCH_LIBDHD",
                                          .library = "libdhd.so.3",
                                          .open = open_force_dimension,
                                          .availability = force_dimension_availability,
                                          .axes = user_right_up(),
                                          .length_per_m = 1,
                                          .torque_per_Nm = 1,
                                          .has_buttons = true,
                                          .drives_itself = false,
                                          .has_motors_on_to_read = false,
                                          .error = 7,
                                          .fault_code = 7,
                                          .unplugged_code = 2};

inline const VendorDevice kOpenHaptics{.name = "open_haptics",
                                       .uri = "touch:",
                                       .double_file = REMOTE_TOUCH_DOUBLE_DEVICES,
                                       .variable = "REMOTE_TOUCH_LIBHD",
                                       .library = "libHD.so",
                                       .open = open_open_haptics,
                                       .availability = open_haptics_availability,
                                       .axes = Eigen::Matrix3d::Identity(),
                                       .length_per_m = 1000,
                                       .torque_per_Nm = 1000,
                                       .has_buttons = true,
                                       .drives_itself = true,
                                       .has_motors_on_to_read = false,
                                       .error = 0x0201,
                                       .fault_code = 0x0201,
                                       .unplugged_code = 0x0302};

inline const VendorDevice kEntact{.name = "entact",
                                  .uri = "entact:",
                                  .double_file = REMOTE_TOUCH_DOUBLE_DEVICES,
                                  .variable = "REMOTE_TOUCH_LIBENTACT",
                                  .library = "libEntactAPI.so",
                                  .open = open_entact,
                                  .availability = entact_availability,
                                  .axes = user_right_up(),
                                  .length_per_m = 1000,
                                  .torque_per_Nm = 1000,
                                  .has_buttons = false,
                                  .drives_itself = false,
                                  .has_motors_on_to_read = true,
                                  .error = 1,
                                  .fault_code = -1,
                                  .unplugged_code = -1};

inline const auto kVendors = testing::Values(&kForceDimension, &kOpenHaptics, &kEntact);
inline std::string vendor_name(const testing::TestParamInfo<const VendorDevice*>& tested) {
  return tested.param->name;
}

using DoubleInstalled = InstalledDouble<DeviceDouble>;

// Runs the device for that many ticks and one more, which only ends it.
inline void run_ticks(HapticDevice& device, int ticks, const std::function<void(int)>& tick) {
  int done = 0;
  device.run([&] {
    if (done == ticks) return false;
    tick(done++);
    return true;
  });
}

// One tick: the reading, its fault, and the fault of the force that was written.
struct TickOnce {
  explicit TickOnce(HapticDevice& device, const Wrench& wrench = {})
      : read(device.read(reading)), written(device.write(wrench)) {}
  DeviceReading reading;
  DeviceFault read, written;
};

// The reading and the fault of one tick after the device has received a force.
inline TickOnce read_once(HapticDevice& device) {
  std::optional<TickOnce> once;
  run_ticks(device, 2, [&](int) { once.emplace(device); });
  return *once;
}

// Nonzero forces and torques that the library received, in order; successive equal ones count once.
inline std::vector<std::array<double, 6>> sent_forces(const DeviceDouble& device) {
  std::vector<std::array<double, 6>> sent;
  for (const DeviceDouble::Event& event : device.events())
    if (event.sent != std::array<double, 6>{} && (sent.empty() || sent.back() != event.sent))
      sent.push_back(event.sent);
  return sent;
}

}  // namespace remote_touch
