// Force Dimension's omega, sigma, delta and lambda and Novint's Falcon, through the vendor's DHD library.
// Written from its documentation and tested with a test double, never with a device.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// address: the number of the device among those connected; "" is 0.
std::unique_ptr<HapticDevice> open_force_dimension(const std::string& address, Clock& clock);

Availability force_dimension_availability();

}  // namespace remote_touch
