// What `remote-touch devices` prints about an adapter.
#pragma once

#include <string>

namespace remote_touch {

struct Availability {
  bool compiled_in = true;
  bool found = false;  // a device that can be opened is present now
  std::string detail;  // what was found, or why nothing was and what would help; one line
};

}  // namespace remote_touch
