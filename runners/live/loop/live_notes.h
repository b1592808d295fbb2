// The report of a live session: its inputs, and notes on what the user may not have intended.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/run_report.h"
#include "runners/live/loop/live_log.h"

namespace remote_touch {

// Returns the phases of a live session: those of Experiment::phases(); those of the scene if the sensor is
// simulated (depth "sim:..."); and those of the hand and the operator if the device is simulated (device
// "sim:...").
std::vector<Phase> simulated_phases(const Experiment& experiment, const std::string& device,
                                    const std::string& depth, const Kernels& kernels);

struct LiveFacts {
  std::string depth;  // the address of the sensor, such as "sim:"
  const SensorView& view;
  const SensedPoints& sensed;  // the frames that were sent to the renderer
  const CameraCounts& camera;
  const LiveLog& log;
  double haptic_rate_hz = 0;
  const std::vector<Phase>& phases;  // see simulated_phases()
};

// Returns one input line, on the frames, and these notes: no frame; no contact; frames unused, if more than a
// tenth of all frames were not used; phase not reached.
RunReport report_of(const LiveFacts& facts);

}  // namespace remote_touch
