// A 3Dconnexion SpaceMouse, through the daemon spacenavd: input only, six axes, no motors. Needs no library.
//
// The address is the path of the daemon's socket, by default that of the environment variable SPNAV_SOCKET,
// or /var/run/spnav.sock, and settings:
//   speed=M_PER_S      speed for each count of deflection, by default 0.0005; a mouse sends up to about 350
//   turning=RAD_PER_S  angular speed for each count of deflection, by default 0.003
//   box=M              half the width of the workspace, by default 0.15; the position is kept within
//
// The deflection is used as a velocity and integrated to a pose, which starts in the middle of the box. A
// deflection is used for at most 0.5 s unless it is reported again, so that an unplugged mouse comes to rest;
// if the daemon does not repeat a constant deflection, set repeat-interval = 250 in its settings. Rotations
// are about the axes of the device's frame, not those of the handle.
//
// Axes of the daemon, as its own library uses them: x to the right, y up, z away from the user, and rotations
// about x, y and -z. The settings of the daemon (spacenavd's configuration file) can change them.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// Throws InputError. read() processes the messages that have arrived and does not wait. It returns a fault
// after the daemon has closed the connection; the device must then be opened again. write() exerts no force
// and returns the fault of read(), if any. release() does nothing.
std::unique_ptr<HapticDevice> open_spacenav(const std::string& address, Clock& clock);

// Reports whether the daemon accepts a connection. The daemon does not report which mouse it has, if any.
Availability spacenav_availability(const std::string& address, const Clock& clock);

}  // namespace remote_touch
