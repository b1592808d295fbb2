// Trial of one frame on an OpenCL device and on the CPU: checks that the device works, whether it gives the
// same bits, and whether it is faster.
#pragma once

#include <string>

#include "core/dissertation/depth/depth_processor.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

struct OpenClDevice;

// A frame of 320 x 240 pixels with holes, processed on the device and on the CPU.
struct DepthTrial {
  std::string failure;  // failure of the device; empty: it works
  bool same_bits = false;
  double device_ms = 0, cpu_ms = 0;  // minimum of five
};

// Tries the device, after the trials of other threads, or returns the earlier result of this process for
// these settings. Failures are not kept, except that of a device that was not opened in time.
DepthTrial tried(const OpenClDevice& device, const DepthPipelineSettings& settings, const Kernels& kernels);
// Forgets the results for a device that has failed since.
void forget_trials(const OpenClDevice& device);

}  // namespace remote_touch
