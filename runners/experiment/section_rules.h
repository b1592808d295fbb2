// Rules between the sections of an experiment.
#pragma once

#include "runners/experiment/configuration.h"

namespace remote_touch {

// Each throws InputError if its section does not fit the others.
void check_fixtures(ExperimentConfiguration& configuration);
// If a fixture needs guidance and the section is missing, adds it with default values, so that results store
// the settings used.
void complete_guidance(ExperimentConfiguration& configuration);
void check_sequence(ExperimentConfiguration& configuration);

}  // namespace remote_touch
