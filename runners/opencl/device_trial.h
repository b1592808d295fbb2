// One frame on an OpenCL device and on the CPU: whether it works, has the same bits, and is faster.
#pragma once

#include <string>

#include "core/depth/depth_processor.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

struct OpenClDevice;

// A frame of 320 x 240 pixels with holes, processed on the device and on the CPU.
struct DepthTrial {
  std::string failure;  // of the device; empty: it works
  bool same_bits = false;
  double device_ms = 0, cpu_ms = 0;  // min of five
};

// Tried now, after those of other threads, or as it was found in this process with these settings. A failure
// is found anew each time, except that of a device that was not opened in time.
DepthTrial tried(const OpenClDevice& device, const DepthPipelineSettings& settings, const Kernels& kernels);
// Forgets what was found of a device that failed since.
void forget_trials(const OpenClDevice& device);

}  // namespace remote_touch
