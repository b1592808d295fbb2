#include <cstdio>

#include "runners/experiment/opencl/depth_device.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {

namespace {

template <class Entry>
void print_entry(const Entry& entry) {
  const Availability availability = entry.availability();
  std::printf("  %-28s %s\n  %-28s %s%s%s\n", entry.example, entry.summary, "",
              availability.compiled_in ? "" : "not compiled in: ",
              !availability.compiled_in || availability.found ? ""
              : availability.was_searched                     ? "not found: "
                                                              : "unknown: ",
              availability.detail.c_str());
}

std::string verdict(const FoundDepthDevice& device) {
  if (!device.trial.failure.empty()) return "cannot be used: " + device.trial.failure;
  char times[120];
  std::snprintf(times, sizeof times, "320 x 240 pixels in %.1f ms, on the CPU in %.1f ms: %s",
                device.trial.device_ms, device.trial.cpu_ms,
                device.trial.device_ms < device.trial.cpu_ms ? "faster" : "not faster");
  return (device.inexact_because.empty() ? "the bits of the CPU; "
                                         : "only with exact = false: it " + device.inexact_because + "; ") +
         times;
}

void print_depth_devices(const Kernels& kernels) {
  std::puts("depth_pipeline.device: OpenCL devices");
  std::string why_none;
  for (const FoundDepthDevice& device : try_depth_devices(kernels, why_none))
    std::printf("  %-28s %s\n  %-28s %s\n", device.address.c_str(), device.name.c_str(), "",
                verdict(device).c_str());
  if (!why_none.empty()) std::printf("  none: %s\n", why_none.c_str());
}

}  // namespace

int command_devices(const CommandLine& line, const DevicesRequest&) {
  std::puts("--device: haptic devices");
  for (const DeviceEntry& entry : devices()) print_entry(entry);
  std::puts("--depth: depth sensors");
  for (const SensorEntry& entry : sensors()) print_entry(entry);
  print_depth_devices(*line.kernels);
  return kDone;
}

}  // namespace remote_touch
