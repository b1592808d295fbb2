// Phases of a motion, and notes on a run for the user.
#pragma once

#include <limits>
#include <string>

namespace remote_touch {

// A remark on a run that the user should read: the run is valid, but it may not be what was meant.
struct Note {
  std::string kind;  // the same for all notes of this kind, see note_kinds(): "no contact"
  std::string text;  // one line
};

// A part of the scripted motion of a scene or of a hand.
struct Phase {
  std::string name;  // name with its article: "the acceleration"
  double begins_s = 0;
  double ends_s = std::numeric_limits<double>::infinity();
};

}  // namespace remote_touch
