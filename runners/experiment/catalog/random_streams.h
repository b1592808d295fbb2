// The random numbers that a run draws, by its configuration.
#pragma once

#include <string>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

class Experiment;

// Returns the streams from which runs of the experiment draw: those of their cell if a deviation, jitter or
// probability of the scene, the sensor, the frames or the links is above 0; that of their replicate if the
// slave has a registration error. A scenario of a plug-in, of Python or of a program's own catalog counts as
// one that draws: it may use the noise key as it likes. The motion `random-motion` has a seed of its own, so
// it is the same in all replicates and draws nothing here.
RandomStreams random_streams(const Experiment& experiment);
// True if a change of the setting at this path, as for --set, may change the streams.
bool may_change_streams(const std::string& path);

}  // namespace remote_touch
