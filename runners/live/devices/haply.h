// Haply Inverse3, through the WebSocket of its Inverse service. Tested against a simulated service only.
//
// The address is ws://HOST:PORT, by default ws://127.0.0.1:10001, and settings:
//   force=vector|values  key of the force in a command: `vector` for version 3.5, `values` for 3.1 to 3.4
//   rate=HZ              rate of the loop, 100 to 8000, by default 1000
//   device=ID handle=ID  the ones to use if there are several; by default the first of the inventory
//   check=on|off         on, the default: read() returns a fault if the force that the service reports does
//                        not follow the commands for 50 ms
//
// The service sends one state for each command and measures it when the command arrives. So the state that a
// tick reads is one period old; a higher rate makes it newer.
//
// The device senses three axes, or six with a handle (VerseGrip). The buttons of the handle are the lowest
// bits. The service reports no angular velocity; it stays 0. The axes of the handle are converted like those
// of the service: its orientation (w, x, y, z) = (1, 0, 0, 0) is the identity here too.
//
// read() ends within 7 ms and write() within 2.5 ms, whatever the service does. They allocate nothing and
// take no lock; the socket is read and written in the tick. A late service causes faults until it answers;
// after any other fault of the connection the device must be opened again.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "runners/live/devices/haply_link.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

using HaplyLinkOpener =
    std::function<std::unique_ptr<HaplyLink>(const DeviceAddress&, const Clock&, double deadline_s)>;

// Throws InputError. Sends a command with zero force, because the service then sends a first state.
//
// release() of the device waits at most 5 ms until no thread is in read() or write(). It then sends such a
// command too and waits at most 20 ms for the answer. In every case it ends the connection: from then on no
// command of this process reaches the service. According to its documentation the service lets the device
// idle when commands stop.
std::unique_ptr<HapticDevice> open_haply(const std::string& address, Clock& clock,
                                         const HaplyLinkOpener& open_link = open_haply_link);

// Queries the service at the default address; waits at most 0.3 s.
Availability haply_availability(const Clock& clock);

}  // namespace remote_touch
