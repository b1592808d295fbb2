// The availability of a device, as `remote-touch devices` prints it.
#pragma once

#include <string>

namespace remote_touch {

struct Availability {
  bool compiled_in = true;
  bool found = false;  // a device that can be opened is present now
  std::string detail;  // the device found, or the reason why there is none and what would help; one line
};

}  // namespace remote_touch
