// The WebSocket connection to Haply's Inverse service. Compiled in if Boost's headers are installed (build
// option REMOTE_TOUCH_HAPLY).
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "runners/live/devices/device_address.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

class HaplyLink {
 public:
  virtual ~HaplyLink() = default;

  // send() and receive() return by the deadline, a time of the clock in seconds. receive() returns up to 1 ms
  // later if a message has begun to arrive by then. They allocate nothing once the first command has been
  // sent. If the service is only late, a later receive() may still return the message. After any other fault
  // the link cannot be used any more.
  virtual DeviceFault send(std::string_view text, double deadline_s) noexcept = 0;
  // text: valid until the next call.
  virtual DeviceFault receive(std::string_view& text, double deadline_s) noexcept = 0;

  // Ends the connection: nothing is sent or received any more, and calls in progress return. Any thread may
  // call it.
  virtual void cut() noexcept = 0;
};

bool haply_link_is_compiled_in();

// place of the address: ws://HOST[:PORT][/PATH], by default ws://127.0.0.1:10001. Throws InputError.
std::unique_ptr<HaplyLink> open_haply_link(const DeviceAddress& address, const Clock& clock,
                                           double deadline_s);

}  // namespace remote_touch
