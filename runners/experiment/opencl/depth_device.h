// Choice of the device that runs the depth pipeline of an experiment: the CPU, or an OpenCL device with the
// same bits.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/opencl/device_pipeline.h"

namespace remote_touch {

// Called once, with one line, when the CPU takes over from a device that failed. Also called with the reason
// why device = auto uses the CPU, once in a process for each reason.
using DepthReport = std::function<void(const std::string& line)>;

struct DepthDeviceSettings : DepthPipelineSettings {
  std::string device = "cpu";
  bool exact = true;

  bool operator==(const DepthDeviceSettings&) const = default;
};

Parameters parameters(DepthDeviceSettings& s);
std::string validate(const DepthDeviceSettings& s);

// Throws InputError, about depth_pipeline.device, if the requested device does not exist, does not work, or
// must be exact and is not.
std::unique_ptr<DepthProcessor> make_depth_processor(const DepthDeviceSettings& settings,
                                                     const Kernels& kernels, const DepthReport& report);

// Returns the name of an OpenCL device for the provenance of results, such as "opencl:0:0 (NAME, PLATFORM)",
// and whether it failed. It is the device of the newest processor that this process made with these settings.
// Empty: the CPU alone.
std::string depth_device_of(const DepthDeviceSettings& settings);

struct FoundDepthDevice {
  std::string address, name;
  std::string inexact_because;  // reported by the device, or found in the trial; empty: it keeps the bits
  DepthTrial trial;
  bool is_usable() const { return trial.failure.empty() && inexact_because.empty(); }
};

// Tries every OpenCL device. If there is none, why_none is the reason.
std::vector<FoundDepthDevice> try_depth_devices(const Kernels& kernels, std::string& why_none);

}  // namespace remote_touch
