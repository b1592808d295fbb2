// The parts of a running live session that do not work at the moment, as texts for the user.
#pragma once

#include <string>

namespace remote_touch {

// Each text is a statement that is true now; it is empty if there is nothing to report.
struct LiveTrouble {
  std::string camera;  // why the scene does not change
  std::string force;   // why the device gets no force, and what the user can do

  bool operator==(const LiveTrouble&) const = default;
};

}  // namespace remote_touch
