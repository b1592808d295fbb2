// Every depth sensor that --depth can name: one line each.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/scenario_camera.h"

namespace remote_touch {

// The objects that a sensor may need. All must outlive it, except shown.
struct SensorContext {
  const Experiment& experiment;
  const Kernels& kernels;
  Clock& clock;
  std::shared_ptr<const ShownScenario> shown = nullptr;  // replaces the experiment's own scenario for sim:
};

struct SensorEntry {
  const char* scheme;
  const char* example;
  const char* summary;
  std::unique_ptr<DepthSource> (*open)(const std::string& address, const SensorContext& context);
  Availability (*availability)();
  bool reads_recording = false;  // the address is the path of a recording
};

std::span<const SensorEntry> sensors();

// Returns the recording that the sensor reads: nothing for cameras, and for sim:, which shows the scenario of
// the experiment.
std::vector<InputPart> sensor_inputs(const std::string& uri);

// Throws InputError when the sensor cannot be opened; for sim: also when the frames of the scenario lack what
// the experiment needs, see Experiment::check_needs().
std::unique_ptr<DepthSource> open_sensor(const std::string& uri, const SensorContext& context);

}  // namespace remote_touch
