// Where the depth pipeline of an experiment runs: on the CPU, or on an OpenCL device with the same bits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/depth/depth_processor.h"
#include "core/kernels/kernels.h"
#include "runners/opencl/device_pipeline.h"

namespace remote_touch {

struct DepthDeviceSettings : DepthPipelineSettings {
  std::string device = "cpu";
  bool exact = true;
};

Parameters parameters(DepthDeviceSettings& s);
std::string validate(const DepthDeviceSettings& s);

// Throws InputError, about depth_pipeline.device, where a device was asked for that is not there, does not
// work, or must be exact and is not.
std::unique_ptr<DepthProcessor> make_depth_processor(const DepthDeviceSettings& settings,
                                                     const Kernels& kernels, DepthReport report);

// A frame of 320 x 240 pixels with holes, processed on the device and on the CPU.
struct DepthTrial {
  std::string failure;  // of the device; empty: it works
  bool same_bits = false;
  double device_ms = 0, cpu_ms = 0;  // min of five
};

struct FoundDepthDevice {
  std::string address, name;
  std::string inexact_because;  // as it says itself, or as the trial showed; empty: it keeps the bits
  DepthTrial trial;
  bool is_usable() const { return trial.failure.empty() && inexact_because.empty(); }
};

// Every OpenCL device, tried. If there is none, why_none says why.
std::vector<FoundDepthDevice> try_depth_devices(const Kernels& kernels, std::string& why_none);

}  // namespace remote_touch
