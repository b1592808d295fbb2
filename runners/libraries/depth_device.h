// Choice of the device that runs the depth pipeline of an experiment: the CPU, or an OpenCL device with the
// same bits.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"
#include "runners/libraries/opencl_devices.h"
#include "runners/libraries/shared_library.h"

namespace remote_touch {

class DeviceFrames;
struct DeviceFrame;

// The depth pipeline on an OpenCL device, with one on the CPU that takes over if the device fails.
class DevicePipeline final : public DepthProcessor {
 public:
  static constexpr std::chrono::milliseconds kFrameLimit{2000};
  static constexpr std::chrono::milliseconds kBuildLimit{120000};  // limit of the build and the first frame

  // Builds the kernels unless this process has them already, and processes a small frame as their first call.
  // Throws OpenClError if that fails, OpenClTimeout if it takes longer than kBuildLimit.
  DevicePipeline(const OpenClDevice& device, const DepthPipelineSettings& settings, const Kernels& kernels,
                 std::function<void(const std::string&)> report,
                 std::chrono::milliseconds frame_limit = kFrameLimit);

  // report() is called once, with the reason in one line, when the CPU takes over. A frame in which the
  // device fails, or takes longer than frame_limit, is processed on the CPU, and so is every frame after it.
  void process_frame(const DepthFrame& frame, PointCloud& cloud) override;

  // Both return false if the device has failed, before or in this frame. They also return false if columns of
  // fixtures are needed but cannot be filled: the cloud already has such columns, or has no colours. The
  // image of a sensor is processed only if the settings filter it.
  bool process_all(PointCloud& cloud, const HueSteps& steps) override;
  bool process_all(const RawDepth& raw, PointCloud& cloud, const HueSteps* steps) override;

  bool uses_device() const { return frames_ != nullptr; }

 private:
  bool process_depths(const DepthFrame& frame, const HueSteps* steps, PointCloud& cloud);
  void start(const DepthFrame& frame, const HueSteps* steps, std::span<const std::uint32_t> colour);
  bool process_on_device();
  void give_up(const std::string& why);

  const OpenClDevice device_;
  const std::function<void(const std::string&)> report_;
  const std::chrono::milliseconds frame_limit_;
  DepthPipeline cpu_;
  std::shared_ptr<DeviceFrames> frames_;  // null after the device has failed
  std::shared_ptr<DeviceFrame> frame_;
  std::unique_ptr<LastingThread> thread_;
};

// Trial of an OpenCL device with a frame of 320 x 240 pixels with holes, which the CPU processes too. It
// finds out whether the device works, gives the same bits, and is faster.
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
