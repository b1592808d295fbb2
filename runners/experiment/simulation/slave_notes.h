// Notes on a slave that could not do what its run is about.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

struct Trace;

// Returns these notes; none for a run without a slave.
// - "slave without surface": the true surface was not known wherever the slave was, or its normal was not
//   known in some tick in which the slave was behind it.
// - "slave without command": the slave never started; or it received no command after its first one although
//   others were meant for it; or it touched, and the hand, which was to feel it, felt no force.
// - "slave starts in contact": the slave was behind the true surface when it was put at its first command, so
//   that the largest force on it, and all that follows from it, is that of this start.
// - "slave loop gains energy": the device gave the hand more than 5 J, as an unstable loop does, while it
//   returned the force on the slave.
std::vector<Note> slave_notes(const Trace& trace);

// Returns notes "setting without effect" on an experiment with a slave:
// - it has fixtures, but the feedback is not rendered. The HIP is then sent to the slave, and the hand does
//   not feel the renderer, so that no fixture holds anything back;
// - hand is simulated and should feel forces of the slave, but there is no section operator: the hand then
//   follows its path, whatever the device exerts. The hand of a recorded session gives no such note.
std::vector<Note> slave_setting_notes(const Experiment& experiment, Experiment::Hand hand);

// Returns a sentence on the first contact of the slave and the largest force on it, or on how near it came to
// the true surface. Empty if there is no slave, or if the surface was not known where it was.
std::string slave_summary(const Trace& trace);

}  // namespace remote_touch
