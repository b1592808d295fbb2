// Touch, Touch X and the Phantoms before them, by the HD library of the vendor's OpenHaptics. Written from
// its documentation and tried with a test double, never with a device.
//
// The vendor's scheduler drives run(). A scheduler that does not start or stops calling is told to the cycle
// as a fault of its readings; release() reaches the device past a callback that hangs.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/availability.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// address: the name that the device has in the vendor's setup; "" is "Default Device".
std::unique_ptr<HapticDevice> open_open_haptics(const std::string& address, Clock& clock);

// Only of the library: it tells of a device when one is opened.
Availability open_haptics_availability();

}  // namespace remote_touch
