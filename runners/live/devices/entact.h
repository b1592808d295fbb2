// Entact's W5D, the device of 7.5, and W7D, through the vendor's EntactAPI. Written from its documentation
// and tested with a test double, never with a device.
//
// Two things differ from the contract of HapticDevice. First, the device reports its pose only while its
// motors are on, and the pose is that at the last force command. So the first read() switches the motors on
// with zero force, and each reading is one tick old. Second, a call that is lost in the network waits for as
// long as the vendor's library does.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// address: network address of the device, "192.168.1.144". If it is empty, the network is queried and the
// first device that answers is opened. A device that is not homed must be held in its calibration position.
std::unique_ptr<HapticDevice> open_entact(const std::string& address, Clock& clock);

// Checks the library only: the library searches for devices when one is opened.
Availability entact_availability();

}  // namespace remote_touch
