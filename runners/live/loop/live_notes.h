// Reports what a live session has read, with notes on what did not happen in it.
#pragma once

#include <string>
#include <vector>

#include "runners/experiment/experiment.h"
#include "runners/live/loop/live_log.h"
#include "runners/simulation/run_report.h"

namespace remote_touch {

// The parts of the motions that the program makes in a live session: those of the scene if the sensor is
// simulated (depth "sim:..."), and those of the hand if the device is.
std::vector<Phase> simulated_phases(const Experiment& experiment, const std::string& device,
                                    const std::string& depth, const Kernels& kernels);

struct LiveFacts {
  std::string depth;  // the address of the sensor, "sim:"
  const SensorView& view;
  const SensedPoints& sensed;  // the frames that were sent to the renderer
  const CameraCounts& camera;
  const LiveLog& log;
  double haptic_rate_hz = 0;
  const std::vector<Phase>& phases;  // see simulated_phases()
};

// inputs: one line on the frames. notes: no frame; no contact; frames unused, if those are more than a tenth
// of all; phase not reached.
RunReport report_of(const LiveFacts& facts);

}  // namespace remote_touch
