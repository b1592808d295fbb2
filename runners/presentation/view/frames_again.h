// The frames of a stored run, made again from its configuration.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "core/rendering/frame.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// Returns the experiment of a stored trace. Throws InputError, about the name, in three cases: the trace is
// of a live run, whose frames came from a sensor at times that only its recording contains; the configuration
// cannot be run; or a recording is not the one that was read.
Experiment experiment_of_run(const TextAttributes& trace, const std::string& name);

// Passes to on_frame the frames that had arrived at one of the times, in order of arrival, as the renderer
// received them. If the experiment has a task, the whole run is simulated again instead, and time_s is not
// used. Throws InputError as the run itself would, and Interrupted.
void replay_frames(const Experiment& experiment, std::span<const double> time_s, const Kernels& kernels,
                   const std::atomic<bool>* stop, const std::function<void(const Frame&)>& on_frame);

}  // namespace remote_touch
