#include "runners/live/sensors/sensor_table.h"

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "runners/experiment/sessions/session_scene.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/sensors/depth_source.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

namespace {

constexpr double kMaxUnits = std::numeric_limits<std::uint16_t>::max();
constexpr double kUnits_m[] = {1e-4, 2e-4, 5e-4, 1e-3, 2e-3};
// Tolerance of equal poses: above the rounding of products of poses, for positions up to 1000 m from the
// origin.
constexpr double kSamePose = 1e-9;
// Limit of the error of the pinhole camera that is fitted to an organised cloud, in the first frame of a
// recording and in later ones, see scenarios/recordings/recording.h.
constexpr double kMaxOff_px = 1;

std::string number(double value) {
  return formatted("%.5g", value);
}

std::string columns_text(int columns) {
  return columns > 0 ? "rows of " + std::to_string(columns) + " points" : "no rows and columns";
}

double unit_for(const FrameEncoder::Settings& settings, const PointCloud& first) {
  if (settings.unit_m > 0) return settings.unit_m;
  if (!first.image) return kUnits_m[0];
  double reach_m = settings.max_depth_m;
  const RigidTransform X_CW = first.image->X_WC.inverse();
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first.is_measured(i)) reach_m = std::max(reach_m, (X_CW * first.point(i)).z());
  for (const double unit_m : kUnits_m)
    if (reach_m <= kMaxUnits * unit_m) return unit_m;
  return *std::rbegin(kUnits_m);
}

// Writes the points, rounded to floats, so that a replay reads the same values.
void write_points(const PointCloud& cloud, SensorFrame& frame) {
  frame.points.clear();
  const auto add = [&](const Vec3& v) {
    for (int k = 0; k < 3; ++k) frame.points.push_back(static_cast<float>(v[k]));
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    add(cloud.point(i));
    if (cloud.has_normals()) add(cloud.normal(i));
  }
}

// Returns the first frame with points, because an empty frame does not show the layout of the later ones. If
// none of the first 100 has points, returns the first frame.
PointCloud first_with_points(const Scenario& scenario) {
  constexpr int kFrames = 100;
  const PointCloud first = scenario.cloud(0);
  if (first.size() > 0) return first;
  for (int i = 1; i < std::min(scenario.frame_count(), kFrames); ++i)
    if (PointCloud cloud = scenario.cloud(i); cloud.size() > 0) return cloud;
  return first;
}

}  // namespace

FrameEncoder::FrameEncoder(const Settings& settings, const PointCloud& first)
    : name_(settings.name), require_(settings.require) {
  view_.metres_per_unit = unit_for(settings, first);
  view_.has_colour = !first.colour.empty();
  SensorFrame frame;
  if (first.image) {
    view_.camera = first.image->camera, view_.X_WC = first.image->X_WC;
    X_CW_ = view_.X_WC.inverse();
    if (write_depth(first, frame).empty()) return;
    view_.camera = {}, view_.X_WC = RigidTransform::Identity();
  }
  view_.cloud = {first.has_normals(), first.columns(), first.size()};
}

// A cloud without an image of its own, but with one point for each pixel of the view, is accepted here; see
// pixel_problem().
std::string FrameEncoder::image_problem(const PointCloud& cloud) const {
  const bool has_size = !cloud.image || (cloud.image->camera.width == view_.camera.width &&
                                         cloud.image->camera.height == view_.camera.height);
  if (!has_size || cloud.size() != view_.camera.pixels())
    return "has " + (has_size ? std::to_string(cloud.size()) + " points" : size_text(cloud.image->camera)) +
           ": expected " + size_text(view_.camera) + ", as the first frame has";
  if (!cloud.image) return {};
  if (((cloud.image->X_WC.matrix() - view_.X_WC.matrix()).array().abs() <= kSamePose).all()) return {};
  const RigidTransform moved = X_CW_ * cloud.image->X_WC;
  return "was captured from another pose (" + number(moved.translation().norm()) + " m and " +
         number(Eigen::AngleAxisd(moved.linear()).angle() / kRadiansPerDegree) +
         " deg from the first frame): expected a camera at rest, because a live run has one pose for all frames";
}

std::string FrameEncoder::layout_problem(const PointCloud& cloud) const {
  const auto has = [](bool normals) { return normals ? "has normals" : "has no normals"; };
  if (cloud.columns() != view_.cloud->grid_columns)
    return "has " + columns_text(cloud.columns()) + ": expected " + columns_text(view_.cloud->grid_columns) +
           ", as the first frame has";
  if (cloud.has_normals() != view_.cloud->has_normals)
    return std::string(has(cloud.has_normals())) + ", and the first frame " + has(!cloud.has_normals()) +
           ": expected normals in all frames or in none";
  return {};
}

std::string FrameEncoder::problem_of(const PointCloud& cloud) const {
  if (!cloud.fixture_radius_m.empty() || !cloud.stiffness_N_per_m.empty())
    return "has forbidden regions or stiffnesses of its own, which no sensor sends: expected rules in fixtures";
  return view_.cloud ? layout_problem(cloud) : image_problem(cloud);
}

// p_C: a measured point, in the camera's frame.
std::string FrameEncoder::pixel_problem(const Vec3& p_C, std::size_t pixel) const {
  const CameraIntrinsics& camera = view_.camera;
  const double z_m = p_C.z();
  if (!(z_m > 0)) return "has a point behind its camera: expected points in front of it";
  if (!(std::round(z_m / view_.metres_per_unit) <= kMaxUnits))
    return "has a point at a depth of " + number(z_m) + " m: expected at most " +
           number(kMaxUnits * view_.metres_per_unit) + " m, 65535 units of " +
           number(1000 * view_.metres_per_unit) + " mm";
  const int place = static_cast<int>(pixel), u = place % camera.width, v = place / camera.width;
  const double off_u = std::abs(camera.fx * p_C.x() + (camera.cx - u) * z_m);
  const double off_v = std::abs(camera.fy * p_C.y() + (camera.cy - v) * z_m);
  if (!(std::max(off_u, off_v) < kMaxOff_px * z_m))
    return "has another camera than the first frame (a point is " + number(std::max(off_u, off_v) / z_m) +
           " px off its pixel): expected the same camera in every frame";
  return {};
}

std::string FrameEncoder::write_depth(const PointCloud& cloud, SensorFrame& frame) const {
  frame.depth.assign(cloud.size(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p_C = X_CW_ * cloud.point(i);
    if (std::string problem = pixel_problem(p_C, i); !problem.empty()) return problem;
    frame.depth[i] = static_cast<std::uint16_t>(std::max(1.0, std::round(p_C.z() / view_.metres_per_unit)));
  }
  return {};
}

void FrameEncoder::write_nothing(SensorFrame& frame) const {
  const std::size_t pixels = view_.cloud ? 0 : view_.camera.pixels();
  frame.depth.assign(pixels, 0);
  frame.colour.assign(view_.has_colour ? pixels : 0, kNoColour);
  frame.points.clear();
}

void FrameEncoder::encode(const PointCloud& cloud, int index, SensorFrame& frame) const {
  std::string problem = problem_of(cloud);
  if (problem.empty() && view_.cloud)
    write_points(cloud, frame);
  else if (problem.empty())
    problem = write_depth(cloud, frame);
  if (!problem.empty() && !cloud.has_measured_point()) return write_nothing(frame);
  if (!problem.empty()) throw InputError(name_, "frame " + std::to_string(index) + " " + problem);
  if (require_ && cloud.size() > 0) require_(cloud);
  frame.colour = view_.has_colour ? cloud.colour : std::vector<std::uint32_t>();
  if (view_.has_colour && cloud.colour.empty()) frame.colour.assign(cloud.size(), kNoColour);
}

ScenarioCamera::ScenarioCamera(std::shared_ptr<const ShownScenario> scenario, Clock& clock,
                               const FrameEncoder::Settings& settings)
    : scenario_(std::move(scenario)),
      encoder_(settings, first_with_points(*scenario_->now())),
      clock_(clock) {
  view_ = encoder_.view();
  view_.frame_rate_hz = scenario_->now()->frame_rate_hz();
}

SensorState ScenarioCamera::next(SensorFrame& frame, double timeout_s) {
  const double moment_s = clock_.now_s();
  if (start_s_ < 0) start_s_ = moment_s;
  const double now_s = moment_s - start_s_;
  const auto scenario = scenario_->now();
  const int last = scenario->frame_count() - 1;
  // The last frame is repeated after the end of the scene.
  const auto due_s = [&](int i) {
    return scenario->captured_s(std::min(i, last)) + std::max(0, i - last) / view_.frame_rate_hz;
  };
  while (due_s(next_ + 1) <= now_s) ++next_;  // if several are due, delivers the newest
  const double captured_s = due_s(next_);
  const double wait_s = captured_s - now_s;
  if (wait_s > 0) clock_.sleep_s(std::min(wait_s, timeout_s));
  if (wait_s > timeout_s) return SensorState::waiting;
  const int shown = std::min(next_, last);
  encoder_.encode(scenario_->cloud(shown), shown, frame);
  frame.number = next_++;
  frame.captured_s = start_s_ + captured_s;
  return SensorState::frame;
}

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
