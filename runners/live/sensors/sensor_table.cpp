#include "runners/live/sensors/sensor_table.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "runners/experiment/sessions/session_scene.h"
#include "runners/live/devices/device_connection.h"
#include "runners/live/sensors/depth_source.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

namespace {

// Returns the depth unit of a recorded session, so that its depths are encoded in the same unit.
double session_unit_m(const std::string& path) {
  return SessionReader(find_input(path)).view().metres_per_unit;
}

// Returns a check of the rules for the scenario's own frames. The encoded frames cannot be checked instead,
// because a sensor with colours sends colours in every frame, also for a frame that has none.
std::function<void(const PointCloud&)> rules_of(const Experiment& experiment) {
  const auto fixtures = std::make_shared<const FixtureAssignment>(experiment.build_fixtures());
  return [fixtures](const PointCloud& cloud) { fixtures->require(cloud); };
}

FrameEncoder::Settings settings_of(const Experiment& experiment) {
  FrameEncoder::Settings settings;
  settings.require = rules_of(experiment);
  if (experiment.value_at_start("scenario.name") == "live-session")
    settings.unit_m = session_unit_m(experiment.value_at_start("scenario.path").get<std::string>());
  if (const auto max_m = experiment.value_at_start("scenario.max_depth_m"); max_m.is_number())
    settings.max_depth_m = max_m.get<double>();
  return settings;
}

std::unique_ptr<DepthSource> open_simulated(const std::string& address, const SensorContext& context) {
  if (!address.empty())
    throw InputError("--depth sim:" + address, "expected sim:, for the experiment's scenario");
  const Experiment& experiment = context.experiment;
  const auto shown = context.shown
                         ? context.shown
                         : std::make_shared<ShownScenario>(experiment.build_scenario(context.kernels));
  experiment.check_needs(*shown->now());
  return std::make_unique<ScenarioCamera>(shown, context.clock, settings_of(experiment));
}

// Plays the recording at its own times, repeatedly, forwards and backwards.
std::unique_ptr<DepthSource> open_recording(const std::string& address, const SensorContext& context) {
  RecordedScene::Settings settings;
  settings.path = address;
  settings.truth = RecordedScene::Truth::measured;
  settings.playback = RecordedScene::Playback::ping_pong;
  auto scene = std::make_unique<RecordedScene>(settings, context.experiment.settings().key, context.kernels);
  return std::make_unique<ScenarioCamera>(
      std::move(scene), context.clock,
      FrameEncoder::Settings{
          .name = address, .max_depth_m = settings.max_depth_m, .require = rules_of(context.experiment)});
}

std::unique_ptr<DepthSource> open_session(const std::string& address, const SensorContext& context) {
  auto session = std::make_unique<SessionScene>(SessionScene::Settings{address},
                                                context.experiment.settings().key, context.kernels);
  return std::make_unique<ScenarioCamera>(
      std::move(session), context.clock,
      FrameEncoder::Settings{.name = address, .unit_m = session_unit_m(address)});
}

template <std::unique_ptr<DepthSource> (*open)(const std::string&, Clock&)>
std::unique_ptr<DepthSource> open_at(const std::string& address, const SensorContext& context) {
  return open(address, context.clock);
}

constexpr SensorEntry kSensors[] = {
    {"sim", "sim:", "the experiment's scenario, in real time", open_simulated,
     [] { return always("simulated"); }},
    {"oni", "oni:any",
     "a camera of OpenNI 2, by its URI or the first there is; or oni:FILE, an .oni recording",
     open_at<open_openni2>, openni2_availability},
    {"freenect", "freenect:NUMBER", "Kinect for Xbox 360, by libfreenect", open_at<open_freenect>,
     freenect_availability},
    {"k4a", "k4a:CAMERA?MODE",
     "Azure Kinect and Orbbec Femto, by number or serial number; MODE: nfov, nfov-binned, wfov-binned, wfov",
     open_at<open_k4a>, k4a_availability},
    {"realsense", "realsense:SERIAL", "Intel RealSense, by librealsense 2", open_at<open_realsense>,
     realsense_availability},
    {"dir", "dir:FOLDER", "a folder of depth images or organised clouds", open_recording,
     [] { return always("reads files"); }, true},
    {"tum", "tum:FOLDER", "a folder in the layout of the TUM RGB-D benchmark", open_recording,
     [] { return always("reads files"); }, true},
    {"pcd", "pcd:FILE", "an organised PCD file, or a folder of them", open_recording,
     [] { return always("reads files"); }, true},
    {"replay", "replay:FILE", "the frames of a recorded live session, in real time", open_session,
     [] { return always("reads files"); }, true},
};

}  // namespace

std::span<const SensorEntry> sensors() {
  return kSensors;
}

std::vector<InputPart> sensor_inputs(const std::string& text) {
  const Uri uri = parse_uri("--depth", text);
  const bool reads_recording =
      find_scheme(sensors(), "--depth", uri).reads_recording || has_ending(uri.address, ".oni");
  if (!reads_recording || uri.address.empty()) return {};
  return {{uri.address}};
}

std::unique_ptr<DepthSource> open_sensor(const std::string& text, const SensorContext& context) {
  const Uri uri = parse_uri("--depth", text);
  return find_scheme(sensors(), "--depth", uri).open(uri.address, context);
}

}  // namespace remote_touch
