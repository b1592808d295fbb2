// Rules between the sections of an experiment.
#pragma once

#include "runners/experiment/catalog/configuration.h"

namespace remote_touch {

// Each throws InputError if its section does not fit the others.
void check_fixtures(ExperimentConfiguration& configuration);
// If a fixture needs guidance and the section is missing, adds it with default values, so that results store
// the settings used.
void complete_guidance(ExperimentConfiguration& configuration);
void check_changes(ExperimentConfiguration& configuration);
void check_sequence(ExperimentConfiguration& configuration);
// Friction and damping of the device need a hand with a mass.
void check_device(ExperimentConfiguration& configuration);
// Links and feedback need a slave. With one, adds those that were left out with default values, so that
// results store the settings used. If the renderer has a tool, the slave has the same one, so it must be
// known. Architectures other than position-force are for a ball; passivity control and waves need an exact
// device, and waves no dead-band. The dead-band of commands must not be relative.
void check_slave(ExperimentConfiguration& configuration);
// True if the renderer has a tool, which a slave then has as well.
bool renders_tool(const ExperimentConfiguration& configuration);

// Returns the largest max_stiffness_N_per_m() of the renderer's settings, at the start and after each change.
// Throws InputError if one of them is not finite or negative, whatever factory it comes from. check_changes()
// calls it, so that no experiment with such a renderer is read.
double max_renderer_stiffness(const ExperimentConfiguration& configuration);

}  // namespace remote_touch
