// Entact's W5D, the device of 7.5, and W7D, through the vendor's EntactAPI. Written from its documentation
// and tested with a test double, never with a device.
//
// Two things differ from the contract of HapticDevice. The device reports its pose only while its motors are
// on, and only as of the last force command: the first read() switches them on with zero force, and a reading
// is one tick old. And a call that the network loses waits for as long as the vendor's library does.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/availability.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// address: network address of the device, "192.168.1.144"; "" queries the network and takes the first that
// answers. A device that is not homed must be held in its calibration position.
std::unique_ptr<HapticDevice> open_entact(const std::string& address, Clock& clock);

// Checks the library only: the library searches for devices when one is opened.
Availability entact_availability();

}  // namespace remote_touch
