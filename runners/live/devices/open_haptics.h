// Touch, Touch X and the Phantoms before them, such as the Omni of 4.3 and 6.3, through the HD library of the
// vendor's OpenHaptics. Written from its documentation and tested with a test double, never with a device.
//
// The vendor's scheduler drives run(). If it does not start, or stops calling, read() returns a fault to the
// cycle; release() reaches the device even if a callback hangs.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// address: the name that the device has in the vendor's setup; "" is "Default Device".
std::unique_ptr<HapticDevice> open_open_haptics(const std::string& address, Clock& clock);

// Checks the library only: the library finds devices only when one is opened.
Availability open_haptics_availability();

}  // namespace remote_touch
