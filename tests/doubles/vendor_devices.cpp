#include "tests/doubles/vendor_devices.h"

#include "runners/live/devices/device_table.h"

namespace remote_touch {

namespace {

// The vendor's frame has x towards the user, y right and z up. The rows are these axes in our frame.
Eigen::Matrix3d user_right_up() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  return axes;
}

}  // namespace

const VendorDevice kForceDimension{.name = "force_dimension",
                                   .uri = "fd:0",
                                   .double_file = REMOTE_TOUCH_DOUBLE_DHD,
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

const VendorDevice kOpenHaptics{.name = "open_haptics",
                                .uri = "touch:",
                                .double_file = REMOTE_TOUCH_DOUBLE_HD,
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

const VendorDevice kEntact{.name = "entact",
                           .uri = "entact:",
                           .double_file = REMOTE_TOUCH_DOUBLE_ENTACT,
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

void PrintTo(const VendorDevice* vendor, std::ostream* out) {
  *out << vendor->name;
}

void run_ticks(HapticDevice& device, int ticks, const std::function<void(int)>& tick) {
  int done = 0;
  device.run([&] {
    if (done == ticks) return false;
    tick(done++);
    return true;
  });
}

std::vector<std::array<double, 6>> sent_forces(const DeviceDouble& device) {
  std::vector<std::array<double, 6>> sent;
  for (const DeviceDouble::Event& event : device.events())
    if (event.sent != std::array<double, 6>{} && (sent.empty() || sent.back() != event.sent))
      sent.push_back(event.sent);
  return sent;
}

ReadOnce read_once(HapticDevice& device) {
  ReadOnce once;
  run_ticks(device, 2, [&](int) {
    once.fault = device.read(once.reading);
    device.write({});
  });
  return once;
}

}  // namespace remote_touch
