// Entact's W5D and W7D, the devices of the dissertation's experiments, by the vendor's EntactAPI. Written
// from its documentation and tried with a test double, never with a device.
//
// Two things differ from what the interface promises. The device tells where it is only while its motors are
// on, and only as of the last force it was told: the first read() switches them on with no force, and a
// reading is one tick old. And a call that the network loses waits for as long as the vendor's library does.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/availability.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// address: that of the device in the network, "192.168.1.144"; "" asks the network and takes the first that
// answers. A device that is not homed must be held in its calibration position.
std::unique_ptr<HapticDevice> open_entact(const std::string& address, Clock& clock);

// Only of the library: devices are looked for when one is opened.
Availability entact_availability();

}  // namespace remote_touch
