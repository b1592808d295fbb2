#include "runners/live/sensors/sensor_table.h"

#include <utility>

#include "runners/live/devices/uri.h"
#include "runners/live/sensors/freenect_camera.h"
#include "runners/live/sensors/k4a_camera.h"
#include "runners/live/sensors/openni2_camera.h"
#include "runners/live/sensors/realsense_camera.h"
#include "runners/live/sensors/scenario_camera.h"
#include "runners/sessions/session_scene.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

namespace {

Availability always(const char* what) {
  return {true, true, what};
}

std::unique_ptr<DepthSource> open_simulated(const std::string& address, SensorContext context) {
  if (!address.empty())
    throw InputError("--depth sim:" + address, "expected sim:, for the experiment's scenario");
  if (!context.scenario) context.scenario = context.experiment.build_scenario(context.kernels);
  return std::make_unique<ScenarioCamera>(std::move(context.scenario), context.clock);
}

// Played at the rate of the recording, over and over, there and back.
std::unique_ptr<DepthSource> open_recording(const std::string& address, SensorContext context) {
  RecordedScene::Settings settings;
  settings.path = address;
  settings.playback = RecordedScene::Playback::ping_pong;
  return std::make_unique<ScenarioCamera>(
      std::make_unique<RecordedScene>(settings, context.experiment.settings().key, context.kernels),
      context.clock);
}

std::unique_ptr<DepthSource> open_session(const std::string& address, SensorContext context) {
  return std::make_unique<ScenarioCamera>(
      std::make_unique<SessionScene>(SessionScene::Settings{address}, context.experiment.settings().key,
                                     context.kernels),
      context.clock);
}

template <std::unique_ptr<DepthSource> (*open)(const std::string&, Clock&)>
std::unique_ptr<DepthSource> open_at(const std::string& address, SensorContext context) {
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
     [] { return always("reads files"); }},
    {"tum", "tum:FOLDER", "a folder in the layout of the TUM RGB-D benchmark", open_recording,
     [] { return always("reads files"); }},
    {"pcd", "pcd:FILE", "an organised PCD file, or a folder of them", open_recording,
     [] { return always("reads files"); }},
    {"replay", "replay:FILE", "the frames of a recorded live session, in real time", open_session,
     [] { return always("reads files"); }},
};

}  // namespace

std::span<const SensorEntry> sensors() {
  return kSensors;
}

std::unique_ptr<DepthSource> open_sensor(const std::string& text, SensorContext context) {
  const Uri uri = parse_uri("--depth", text);
  return find_scheme(sensors(), "--depth", uri).open(uri.address, std::move(context));
}

}  // namespace remote_touch
