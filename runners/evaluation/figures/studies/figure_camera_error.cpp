// The error of the renderer and the error of the camera, on recordings whose true surfaces are known.
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/camera_errors.h"

namespace remote_touch {

namespace {

using Json = nlohmann::ordered_json;

// A recording of the figure, and the uncertainty of its truth if its truth.json does not state one.
struct JudgedRecording {
  std::string path, title;
  double uncertainty_m;  // stated by the description of the recording
  std::size_t objects;   // largest number of objects that are touched
};
const JudgedRecording kJudged[] = {{"rgbd/visp_cube_dragon", "", 0.003, 2},
                                   {"rgbd/visp_teabox_synthetic", "rendered ", 0, 1}};
constexpr double kAssumedUncertainty_m = 0.003;  // if nothing is stated
constexpr std::size_t kMostObjects = 3;
constexpr int kMostFrames = 150;

// The scenario section of an experiment on the recording, with the settings of the user.
Json judged_scenario(const std::string& path, const std::vector<std::string>& overrides) {
  for (const std::string& assignment : overrides)
    if (assignment.rfind("scenario.", 0) != 0)
      throw InputError("--set " + assignment,
                       "expected a setting of the recording, such as scenario.path=DIR");
  const Json configuration = {{"scenario", {{"name", "recording"}, {"path", path}, {"truth", "mesh"}}},
                              {"renderer", {{"name", "proxy"}}},
                              {"trajectory", {{"name", "poses"}}},
                              {"duration_s", 1}};
  return Json::parse(Experiment::from_json(configuration.dump(), "figure camera-error", overrides).to_json())
      .at("scenario");
}

// An experiment on the recording without a hand, from which its scene is built.
Experiment scene_experiment(const Json& scenario) {
  return Experiment::from_json(Json{{"scenario", scenario},
                                    {"renderer", {{"name", "proxy"}}},
                                    {"trajectory", {{"name", "poses"}}},
                                    {"duration_s", 1}});
}

// A scene with its truth, and the windows around the points that are touched.
struct JudgedScene {
  Json scenario;
  std::unique_ptr<Scenario> owner;
  const RecordedScene* scene;
  int frames;
  std::vector<std::unique_ptr<const RecordingWindow>> windows;
};

JudgedScene judged_scene(FigureContext& context, const Json& scenario, std::size_t most_objects) {
  const Experiment experiment = scene_experiment(scenario);
  context.uses(experiment);
  JudgedScene judged{scenario, experiment.build_scenario(context.kernels()), nullptr, 0, {}};
  judged.scene = dynamic_cast<const RecordedScene*>(judged.owner.get());
  if (!judged.scene || !judged.scene->truth())
    throw InputError("figure camera-error",
                     "its scenario has no true meshes: expected a recording with truth/");
  judged.frames = std::min(judged.scene->frame_count(), kMostFrames);
  const std::vector<TouchedPoint> points = touched_points(*judged.scene, judged.frames / 2, most_objects);
  if (points.empty())
    throw InputError(scenario.at("path").get<std::string>(),
                     "no true object can be touched in frame " + std::to_string(judged.frames / 2) +
                         ": expected a measured surface without holes and edges within 10 mm");
  judged.windows = windows_around(points, *judged.scene, judged.frames);
  return judged;
}

// Returns the errors of each toucher on each window: errors[window][toucher]. Runs are made in parallel.
std::vector<std::vector<std::vector<ContactError>>> all_contact_errors(FigureContext& context,
                                                                       const JudgedScene& judged,
                                                                       const std::vector<Toucher>& touchers) {
  std::vector<Experiment> experiments;
  for (const auto& window : judged.windows)
    for (const Toucher& toucher : touchers)
      experiments.push_back(pressing_experiment(judged.scenario, *window, toucher));
  for (std::size_t run = 0; run < experiments.size(); run += touchers.size()) context.uses(experiments[run]);
  const auto window_of = [&](std::size_t run) -> const RecordingWindow& {
    return *judged.windows[run / touchers.size()];
  };
  const auto contacts_W = context.collect(experiments.size(), [&](std::size_t run) {
    return contact_points(experiments[run], window_of(run), touchers[run % touchers.size()].rest_distance_m,
                          context.kernels());
  });
  std::vector<std::vector<std::vector<ContactError>>> errors(judged.windows.size());
  for (std::size_t run = 0; run < contacts_W.size(); ++run)
    errors[run / touchers.size()].push_back(contact_errors(contacts_W[run], window_of(run)));
  return errors;
}

std::vector<std::vector<DepthErrors>> point_errors(const JudgedScene& judged, const Kernels& kernels) {
  std::vector<DepthPipelineSettings> settings;
  for (const DepthSetting& setting : depth_settings())
    if (const auto pipeline = pipeline_of(setting)) settings.push_back(*pipeline);
  std::vector<std::size_t> objects;
  for (const auto& window : judged.windows) objects.push_back(window->point().index);
  return depth_errors(*judged.scene, objects, settings, {judged.frames, 10, 3}, kernels);
}

// Adds the errors of each touched object. number: number of the recording.
void add_recording(FigureContext& context, const JudgedRecording& recording, int number,
                   const std::vector<std::string>& overrides, std::vector<TouchedObject>& objects) {
  const JudgedScene judged =
      judged_scene(context, judged_scenario(recording.path, overrides), recording.objects);
  std::vector<Toucher> touchers = compared_renderers();
  for (const DepthSetting& setting : depth_settings()) touchers.push_back(toucher_of(setting));
  auto errors = all_contact_errors(context, judged, touchers);
  const std::vector<std::vector<DepthErrors>> points = point_errors(judged, context.kernels());
  const double stated_m = judged.scene->truth()->uncertainty_m();
  for (std::size_t i = 0; i < judged.windows.size(); ++i) {
    TouchedObject object;
    object.table = "recording_" + std::to_string(number) + "_object_" + std::to_string(i + 1);
    object.title = recording.title + judged.windows[i]->point().object;
    object.uncertainty_m = std::isnan(stated_m) ? recording.uncertainty_m : stated_m;
    for (int frame = 0; frame < judged.frames; ++frame)
      object.captured_s.push_back(judged.scene->captured_s(frame));
    const auto first_setting = errors[i].begin() + static_cast<std::ptrdiff_t>(compared_renderers().size());
    object.settings.assign(first_setting, errors[i].end());
    object.renderers.assign(errors[i].begin(), first_setting);
    for (const std::vector<ContactError>& of_setting : object.settings)
      object.known_frames.push_back(statistics_of(of_setting, total_error_m).frames);
    keep_common_frames(object.settings);
    object.points = points[i];
    objects.push_back(std::move(object));
  }
}

// Returns the recordings of the figure, or the one that the user names.
std::vector<JudgedRecording> judged_recordings(const std::vector<std::string>& overrides) {
  const std::string path = "scenario.path=";
  for (const std::string& assignment : overrides)
    if (assignment.rfind(path, 0) == 0)
      return {{assignment.substr(path.size()), "", kAssumedUncertainty_m, kMostObjects}};
  return {std::begin(kJudged), std::end(kJudged)};
}

// --- claims ---

// Returns the camera's rms error divided by the renderer's, for each renderer.
std::vector<double> error_ratios(const TouchedObject& object) {
  std::vector<double> ratios;
  for (const std::vector<ContactError>& errors : object.renderers)
    ratios.push_back(statistics_of(errors, camera_error_m).rms_m /
                     statistics_of(errors, renderer_error_m).rms_m);
  return ratios;
}

double largest_rms_m(const TouchedObject& object, ErrorValue value) {
  std::vector<double> rms_m;
  for (const std::vector<ContactError>& errors : object.renderers)
    rms_m.push_back(statistics_of(errors, value).rms_m);
  return max_of(rms_m);
}

// Returns the value of the best setting, or of another one, divided by the value without a filter.
double of_unfiltered(const std::vector<double>& values, std::size_t setting) {
  return values[setting] / values[0];
}
double best_of_unfiltered(const std::vector<double>& values) {
  return of_unfiltered(values, best_setting(values));
}

void add_known_checks(Figure& figure, const std::vector<TouchedObject>& objects) {
  const Claims checks(figure, "", &Claim::set_up);
  for (const TouchedObject& object : objects)
    for (std::size_t i = 0; i < object.renderers.size(); ++i) {
      const double known = statistics_of(object.renderers[i], total_error_m).frames;
      checks.at_least(object.title + ", " + compared_renderers()[i].name +
                          ": both errors are known in most frames, of which a hand presses four fifths: "
                          "fraction of frames",
                      known / static_cast<double>(object.captured_s.size()), 0.5, "fraction");
    }
}

// The claims about the two recordings of the figure. The limits were set after the figure had been seen.
void add_recording_claims(Figure& figure, const std::vector<TouchedObject>& objects) {
  const Claims claims(figure);
  std::vector<double> by_measured, by_true, of_default, over_time;
  for (const TouchedObject& object : objects) {
    if (object.uncertainty_m == 0) {
      for (const auto& [what, value] :
           {std::pair{"renderer", &renderer_error_m}, {"camera", &camera_error_m}})
        claims.at_most(object.title + ": the " + what +
                           " errs by less than the steps of the stored depth: largest rms error of three "
                           "renderers",
                       largest_rms_m(object, value), 0.0006, "m");
      continue;
    }
    claims.at_least(object.title +
                        ": the camera errs much more than the renderer: smallest ratio of their rms errors "
                        "of three renderers",
                    min_of(error_ratios(object)), 5, "ratio");
    const std::vector<double> measured_m = points_to_measured_m(object), true_m = points_to_true_m(object);
    by_measured.push_back(best_of_unfiltered(measured_m)), by_true.push_back(best_of_unfiltered(true_m));
    of_default.push_back(true_m[default_setting()] / true_m[best_setting(true_m)]);
    const std::vector<std::vector<ContactError>>& settings = object.settings;
    over_time.push_back(statistics_of(settings[spatial_count()], total_error_m).rms_m /
                        statistics_of(settings[0], total_error_m).rms_m);
  }
  claims.at_most(
      "the best spatial filter brings the points near to the measured surface: largest rms distance of two "
      "objects, divided by the one without a filter",
      max_of(by_measured), 0.3, "ratio");
  claims.at_least(
      "no spatial filter brings the points nearer to the true surface: smallest rms distance of two objects, "
      "divided by the one without a filter",
      min_of(by_true), 0.95, "ratio");
  claims.at_most(
      "the default filter is nearly the best by the true surface: largest rms distance of two objects, "
      "divided by the one of the best setting",
      max_of(of_default), 1.02, "ratio");
  claims.at_least(
      "while the camera moves, the filter over time does not bring the contact point nearer to the true "
      "surface: smallest rms height of two objects, divided by the one without a filter",
      min_of(over_time), 0.95, "ratio");
}

std::string camera_error_caption(bool is_of_user) {
  return std::string(is_of_user ? "A recording" : "Two recordings") +
         " with true objects: meshes, and their pose in each frame. A hand holds the middle of an object by its "
         "true pose, 10 mm behind the true surface, and comes again every 15 frames. The error of the "
         "renderer is the height of the contact point over the measured surface (a plane through the "
         "pixels within 6 mm); the error of the camera is the height of the measured surface over the "
         "true one at the same point. Their sum is the height over the true surface. Each frame is shown by "
         "its last tick; gaps are approaches, and frames in which one of the surfaces is unknown there. Band: "
         "the uncertainty of the truth, 3 mm if nothing else is stated. Right: the proxy behind the spatial "
         "filter (7.1) of the depth pipeline, over the width of its window with sigma_f = 25 mm, over the "
         "frames that all settings know; dots at 1: filters over time without it. Bottom: the same filters, "
         "for every point of the objects in every tenth frame.";
}

}  // namespace

Figure figure_camera_error(FigureContext& context) {
  const std::vector<std::string>& overrides = context.overrides();
  std::vector<TouchedObject> objects;
  int number = 0;
  for (const JudgedRecording& recording : judged_recordings(overrides))
    add_recording(context, recording, ++number, overrides, objects);
  Figure figure{"camera-error", "Error of the renderer and error of the camera",
                camera_error_caption(!overrides.empty())};
  int row = 0;
  for (const TouchedObject& object : objects) add_object(figure, object, row++);
  add_comparisons(figure, objects, row);
  if (overrides.empty()) add_recording_claims(figure, objects);
  add_known_checks(figure, objects);
  return figure;
}

}  // namespace remote_touch
