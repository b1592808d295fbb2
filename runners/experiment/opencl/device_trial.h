// Trial of an OpenCL device with one frame that the CPU processes too. It finds out whether the device works,
// gives the same bits, and is faster.
#pragma once

#include <string>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

struct OpenClDevice;

// A frame of 320 x 240 pixels with holes, processed on the device and on the CPU.
struct DepthTrial {
  std::string failure;  // failure of the device; empty: it works
  bool same_bits = false;
  double device_ms = 0, cpu_ms = 0;  // minimum of five
};

// Returns the earlier result of this process for this device and these settings. If there is none, tries the
// device, after the trials of other threads. A failure is not stored, so that the next call tries again; only
// the failure to open the device in time is stored.
DepthTrial trial_of(const OpenClDevice& device, const DepthPipelineSettings& settings,
                    const Kernels& kernels);
// Forgets the results for a device that has failed since.
void forget_trials(const OpenClDevice& device);

}  // namespace remote_touch
