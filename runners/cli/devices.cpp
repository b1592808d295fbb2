#include <cstdio>

#include "runners/cli/commands.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {

namespace {

template <class Entry>
void print_entry(const Entry& entry) {
  const Availability availability = entry.availability();
  std::printf("  %-28s %s\n  %-28s %s%s%s\n", entry.example, entry.summary, "",
              availability.compiled_in ? "" : "not compiled in: ",
              availability.compiled_in && !availability.found ? "not found: " : "",
              availability.detail.c_str());
}

}  // namespace

int command_devices(const CommandLine&, const DevicesRequest&) {
  std::puts("--device: haptic devices");
  for (const DeviceEntry& entry : devices()) print_entry(entry);
  std::puts("--depth: depth sensors");
  for (const SensorEntry& entry : sensors()) print_entry(entry);
  return kDone;
}

}  // namespace remote_touch
