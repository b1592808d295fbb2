// The recordings that a live run reads, for the hashes in its results.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// Returns the recordings, sessions and meshes that run_live() opens with this device and this sensor:
// - the files of --depth and of --device replay:;
// - the recording of the scenario, if the scenario is the sensor (sim:), or if a hand is simulated (sim:,
//   browser:, replay:), because its motion is planned in the scenario. has_view: the page of --view shows
//   where that motion begins, so the recording is read too;
// - the file of the trajectory, if the device is sim: or browser:, or there is a page;
// - the files of all other sections of the experiment.
// Throws InputError for an address without a known scheme.
std::vector<RecordingPart> live_inputs(const Experiment& experiment, const std::string& device,
                                       const std::string& depth, bool has_view);

}  // namespace remote_touch
