// Every depth sensor that --depth can name: one line each.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "runners/experiment/experiment.h"
#include "runners/live/devices/availability.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

struct SensorEntry {
  const char* scheme;
  const char* example;
  const char* summary;
  std::unique_ptr<DepthSource> (*open)(const std::string& address, const Experiment& experiment,
                                       const Kernels& kernels, Clock& clock);
  Availability (*availability)();
};

std::span<const SensorEntry> sensors();

// Throws InputError when the sensor cannot be opened.
std::unique_ptr<DepthSource> open_sensor(const std::string& uri, const Experiment& experiment,
                                         const Kernels& kernels, Clock& clock);

}  // namespace remote_touch
