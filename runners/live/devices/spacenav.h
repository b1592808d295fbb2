// A 3Dconnexion SpaceMouse, by the daemon spacenavd: input only, six axes, no motors. Needs no library.
//
// The address is the path of the daemon's socket, by default that of the environment variable SPNAV_SOCKET,
// or /var/run/spnav.sock, and settings:
//   speed=M_PER_S      for each count of deflection, by default 0.0005; a mouse gives up to about 350
//   turning=RAD_PER_S  likewise, by default 0.003
//   box=M              half the width of the workspace, by default 0.15; the position is kept within
//
// The deflection is a speed: from the middle of the box, which is where a device begins, counts add up to a
// pose while time passes between readings. A deflection holds for 0.5 s unless it is told anew, so that a
// mouse that is pulled out comes to rest; where one that is held still tells nothing anew, repeat-interval =
// 250 in the daemon's settings lets it go on. Turns are about the axes of the device's frame, not those of
// the handle.
//
// Axes of the daemon, as its own library uses them: x to the right, y up, z away from the user, and turns
// about x, y and -z. The settings of the daemon (spacenavd's configuration file) change them.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/availability.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// Throws InputError. read() takes what is there and does not wait; when the daemon has gone it tells a fault,
// and the device is to be opened anew. write() is accepted and does nothing, and so does release().
std::unique_ptr<HapticDevice> open_spacenav(const std::string& address, Clock& clock);

// Whether the daemon answers; it is not told which mouse it has, if any.
Availability spacenav_availability(const std::string& address, const Clock& clock);

}  // namespace remote_touch
