// What has to hold between the sections of an experiment.
#pragma once

#include "runners/experiment/configuration.h"

namespace remote_touch {

// Each throws InputError where its section does not fit the others.
void check_fixtures(ExperimentConfiguration& configuration);
// Guidance that a fixture needs and that was left out gets its defaults: results say what a run was made
// with.
void complete_guidance(ExperimentConfiguration& configuration);
void check_sequence(ExperimentConfiguration& configuration);

}  // namespace remote_touch
