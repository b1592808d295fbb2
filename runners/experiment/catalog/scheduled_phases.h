// The parts of an experiment that begin at a set time, apart from the motions of the scene and of the hand.
#pragma once

#include <vector>

#include "scenarios/interface/note.h"

namespace remote_touch {

struct ExperimentConfiguration;

// Returns a phase for each change of the renderer, for each part of a fixture's schedule in which the
// strength changes, and for each step of the sequence with a not_before_s above 0.
std::vector<Phase> setting_phases(const ExperimentConfiguration& configuration);

// Returns a phase for each button press of the simulated operator, and for each part of the schedule in which
// the grip changes. Returns none if there is no operator.
std::vector<Phase> operator_phases(const ExperimentConfiguration& configuration);

}  // namespace remote_touch
