#include "runners/live/loop/live_inputs.h"

#include "runners/live/devices/device_address.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {

std::vector<RecordingPart> live_inputs(const Experiment& experiment, const std::string& device,
                                       const std::string& depth, bool has_view) {
  const Uri hand = parse_uri("--device", device);
  const std::string scheme = find_scheme(devices(), "--device", hand).scheme;
  const std::vector<RecordingPart> sensed = sensor_inputs(depth);
  const bool is_replayed = scheme == "replay";
  const bool reads_trajectory = has_view || scheme == "sim" || scheme == "browser";
  std::vector<std::string> except;
  if (!reads_trajectory) except.emplace_back("trajectory");
  if (!reads_trajectory && !is_replayed && !depth.starts_with("sim:")) except.emplace_back("scenario");
  std::vector<RecordingPart> inputs = experiment.inputs(except);
  if (is_replayed && !hand.address.empty()) inputs.push_back({hand.address});
  inputs.insert(inputs.end(), sensed.begin(), sensed.end());
  return inputs;
}

}  // namespace remote_touch
