// Every haptic device that --device can name: one line each.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "runners/experiment/catalog/experiment.h"
#include "runners/live/devices/built_in_devices.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// The objects that a device may need. All but poses must outlive it.
struct DeviceContext {
  const Experiment& experiment;
  const Kernels& kernels;
  Clock& clock;
  std::shared_ptr<HandPoses> poses = nullptr;  // poses from a page of the viewer, for browser:
};

struct DeviceEntry {
  const char* scheme;
  const char* example;
  const char* summary;
  std::unique_ptr<HapticDevice> (*open)(const std::string& address, const DeviceContext& context);
  Availability (*availability)();
};

std::span<const DeviceEntry> devices();

// Throws InputError when the device cannot be opened.
std::unique_ptr<HapticDevice> open_device(const std::string& uri, const DeviceContext& context);

}  // namespace remote_touch
