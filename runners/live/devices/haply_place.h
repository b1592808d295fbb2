// The host, port and target at which Haply's service listens.
#pragma once

#include <string>

#include "runners/live/devices/device_address.h"

namespace remote_touch {

struct HaplyPlace {
  std::string host = "127.0.0.1", port = "10001", target = "/";

  // Returns HOST:PORT, with an IPv6 address in brackets, as in an address of the Web.
  std::string authority() const;
};

// place of the address: ws://HOST[:PORT][/PATH], or nothing. Throws InputError.
HaplyPlace haply_place(const DeviceAddress& address);

}  // namespace remote_touch
