#include "runners/experiment/catalog/random_streams.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "scenarios/camera/depth_sensor.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

using Names = std::vector<std::string>;

// The deviations, jitters and probabilities, by section; the first is the level of the sections.
const Names kOfRun = {"frame_jitter_s", "frame_drop_probability"};
const Names kOfScene = {"noise_sigma_m", "noise_per_m", "colour_noise", "dropout_probability",
                        "turbidity_per_m"};
const Names kOfSensor = {"name", "sensor", "noise_px", "disparity_step_px", "lateral_noise_px"};
const Names kOfFaults = {"repeat_probability",  "ray_noise_m",   "flying_probability",
                         "outlier_probability", "hole_fraction", "dropout_probability",
                         "late_probability"};
const Names kOfLink = {"jitter_s", "loss_probability"};
const Names kOfRegistration = {"offset_m", "rotation_deg"};

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_any_above_0(const Json& section, const Names& parameters) {
  for (const std::string& name : parameters)
    if (const auto found = section.find(name);
        found != section.end() && found->is_number() && found->get<double>() > 0)
      return true;
  return false;
}

// True if a triangulating sensor may draw. The rounding of active stereo may be all of its noise; structured
// light has more where it meets a surface at an angle.
bool triangulation_draws(const Json& scene) {
  const bool is_structured = scene["sensor"] == "structured-light";
  DepthSensorSettings settings;
  settings.sensor = is_structured ? DepthSensorKind::structured_light : DepthSensorKind::active_stereo;
  settings.noise_px = scene.value("noise_px", -1.0);
  settings.disparity_step_px = scene.value("disparity_step_px", -1.0);
  settings.lateral_noise_px = scene.value("lateral_noise_px", -1.0);
  const Triangulation t = triangulation(settings);
  const double rounding = is_structured ? 0 : t.step_px * t.step_px / 12;
  return t.lateral_noise_px > 0 || t.noise_px * t.noise_px > rounding;
}

bool scene_draws(const Json& scene) {
  static const Names known = {"flat-grid",    "moving-lift", "moving-shape",  "plates",       "triangle-wave",
                              "camera-scene", "points",      "beating-heart", "valve-tank",   "box",
                              "slot",         "wedge",       "panel",         "moving-plane", "recording",
                              "mesh-scene",   "live-session"};
  if (!has(known, scene.value("name", ""))) return true;
  if (scene.contains("sensor") && scene["sensor"] != "simple") return triangulation_draws(scene);
  return is_any_above_0(scene, kOfScene);
}

}  // namespace

RandomStreams random_streams(const Experiment& experiment) {
  const Json json = parse_json(experiment.to_json(), "an experiment");
  const auto section = [&](const char* name) {
    const Json found = json.value(name, Json::object());
    return found.is_object() ? found : Json::object();
  };
  RandomStreams streams;
  streams.of_cell = is_any_above_0(json, kOfRun) || scene_draws(section("scenario")) ||
                    is_any_above_0(section("faults"), kOfFaults) ||
                    is_any_above_0(section("command_link"), kOfLink) ||
                    is_any_above_0(section("force_link"), kOfLink);
  streams.of_replicate = is_any_above_0(section("registration"), kOfRegistration);
  return streams;
}

bool may_change_streams(const std::string& path) {
  const std::vector<std::string> keys = path_keys(path);
  const std::string& section = keys.front();
  if (has(kOfRun, section)) return true;
  const auto names_one = [&](const Names& names) { return keys.size() == 1 || has(names, keys[1]); };
  if (section == "scenario") return names_one(kOfScene) || names_one(kOfSensor);
  if (section == "faults") return names_one(kOfFaults);
  if (section == "command_link" || section == "force_link") return names_one(kOfLink);
  return section == "registration" && names_one(kOfRegistration);
}

}  // namespace remote_touch
