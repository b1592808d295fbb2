// Notes on a slave that could not do what its run is about.
#pragma once

#include <vector>

#include "scenarios/interface/note.h"

namespace remote_touch {

struct Trace;

// Returns a note "slave without surface" if the true surface was not known wherever the slave was, and a note
// "slave without command" if it received no command after its first one although others were meant for it,
// and a note "slave loop gains energy" if the device gave the hand more than 5 J, as an unstable loop does.
// Returns no notes for a run without a slave.
std::vector<Note> slave_notes(const Trace& trace);

}  // namespace remote_touch
