#include "runners/live/devices/device_table.h"

#include <utility>

#include "runners/experiment/sessions/session_scene.h"
#include "runners/live/devices/built_in_devices.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/device_connection.h"
#include "runners/live/devices/haply.h"

namespace remote_touch {

namespace {

// Returns the trajectory of an experiment. It keeps the scenario, whose frames it may read at any time.
std::shared_ptr<const Trajectory> script_of(const DeviceContext& context) {
  const std::shared_ptr<const Scenario> scenario = context.experiment.build_scenario(context.kernels);
  const std::shared_ptr<const Trajectory> trajectory = context.experiment.build_trajectory(*scenario);
  return {trajectory.get(), [scenario, trajectory](const Trajectory*) {}};
}

// The hand starts at the first pose of the experiment's trajectory.
std::unique_ptr<HapticDevice> open_browser(const std::string& address, const DeviceContext& context) {
  if (!address.empty()) throw InputError("--device browser:" + address, "expected browser:");
  if (!context.poses) throw InputError("--device browser:", "needs a page: expected the option --view too");
  const Experiment& experiment = context.experiment;
  return std::make_unique<BrowserDevice>(context.poses, script_of(context)->at(0),
                                         DevicePlacement(experiment.live()),
                                         experiment.settings().haptic_rate_hz, context.clock);
}

std::unique_ptr<HapticDevice> open_simulated(const std::string& address, const DeviceContext& context) {
  const Experiment& experiment = context.experiment;
  if (!address.empty())
    throw InputError("--device sim:" + address,
                     "expected sim:, for the experiment's trajectory and operator");
  return std::make_unique<SimulatedDevice>(script_of(context), experiment.build_hand(),
                                           DevicePlacement(experiment.live()),
                                           experiment.settings().haptic_rate_hz, context.clock);
}

// Opens the hand of a recorded session. It moves in real time and does not respond to forces.
std::unique_ptr<HapticDevice> open_session(const std::string& address, const DeviceContext& context) {
  const Experiment& experiment = context.experiment;
  const auto scenario = experiment.build_scenario(context.kernels);
  const double rate_hz = experiment.settings().haptic_rate_hz;
  return std::make_unique<SimulatedDevice>(
      std::make_unique<SessionHand>(SessionHand::Settings{address}, *scenario),
      SimulatedHand({}, {}, 1 / rate_hz), DevicePlacement(experiment.live()), rate_hz, context.clock);
}

template <std::unique_ptr<HapticDevice> (*open)(const std::string&, Clock&)>
std::unique_ptr<HapticDevice> open_at(const std::string& address, const DeviceContext& context) {
  return open(address, context.clock);
}

constexpr DeviceEntry kDevices[] = {
    {"sim", "sim:", "the experiment's trajectory, with its operator who feels the force; no hardware",
     open_simulated, [] { return always("simulated"); }},
    {"browser", "browser:", "the mouse, in the page of --view; input only", open_browser,
     [] { return always("with --view"); }},
    {"fd", "fd:NUMBER", "Force Dimension omega, sigma, delta, lambda, and Novint Falcon",
     open_at<open_force_dimension>, force_dimension_availability},
    {"touch", "touch:NAME", "Touch, Touch X and Phantoms, by OpenHaptics", open_at<open_open_haptics>,
     open_haptics_availability},
    {"entact", "entact:IP", "Entact W5D and W7D", open_at<open_entact>, entact_availability},
    {"haply", "haply:ws://127.0.0.1:10001", "Haply Inverse3, by the WebSocket of its service",
     [](const std::string& address, const DeviceContext& context) {
       return open_haply(address, context.clock);
     },
     [] { return haply_availability(steady_clock()); }},
    {"spnav", "spnav:PATH", "3Dconnexion SpaceMouse, by spacenavd; input only", open_at<open_spacenav>,
     [] { return spacenav_availability("", steady_clock()); }},
    {"replay", "replay:FILE", "the hand of a recorded live session; no hardware", open_session,
     [] { return always("reads files"); }},
};

}  // namespace

std::span<const DeviceEntry> devices() {
  return kDevices;
}

std::unique_ptr<HapticDevice> open_device(const std::string& text, const DeviceContext& context) {
  const Uri uri = parse_uri("--device", text);
  return find_scheme(devices(), "--device", uri).open(uri.address, context);
}

}  // namespace remote_touch
