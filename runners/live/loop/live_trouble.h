// Describes, for the user, the parts of a running live session that do not work at the moment.
#pragma once

#include <string>

namespace remote_touch {

// Each text is one statement that is true now; empty: nothing to report.
struct LiveTrouble {
  std::string camera;  // why the scene does not change
  std::string force;   // why the device gets no force, and what would help

  bool operator==(const LiveTrouble&) const = default;
};

}  // namespace remote_touch
