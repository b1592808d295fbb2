#include "runners/experiment/catalog/frame_stream.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <sstream>

#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/sessions/sensor_frame.h"

namespace remote_touch {
namespace {

class ScenarioTruth final : public TrueSurface {
 public:
  explicit ScenarioTruth(const Scenario& scenario) : scenario_(scenario) {}
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scenario_.signed_distance(p_W, time_s);
  }

 private:
  const Scenario& scenario_;
};

// The properties that all frames of a run have, before the depth pipeline.
struct FrameContents {
  bool normals = false, organised = false, image = false;
};

// Returns true for a grid with triangles: a single row or column has none.
bool is_organised(int columns, std::size_t points) {
  return columns > 1 && points >= 2 * static_cast<std::size_t>(columns);
}

FrameContents contents_of(const PointCloud& cloud) {
  return {cloud.has_normals(), is_organised(cloud.columns(), cloud.size()), cloud.image.has_value()};
}

FrameContents contents_of(const SensorView& view) {
  if (!view.cloud) return {.organised = true, .image = true};
  return {view.cloud->has_normals, view.cloud->grid_columns > 1};
}

bool contains(const std::vector<FrameNeed>& needs, FrameNeed need) {
  return std::find(needs.begin(), needs.end(), need) != needs.end();
}

const RendererEntry& entry_of(const ExperimentConfiguration& configuration) {
  return find_entry(renderers(), configuration.renderer.name, "renderer.name");
}

std::string subject(const std::string& renderer) {
  return "renderer.name = \"" + renderer + "\"";
}

template <class Value>
const Value* setting(Configurable& settings, const std::string& name) {
  for (const Parameter& p : settings.settings())
    if (Value* const* value = std::get_if<Value*>(&p.value); value && p.name == name) return *value;
  return nullptr;
}

std::string text(const Vec3& v) {
  std::ostringstream out;
  out.precision(2);
  const auto rounded = [](double x) { return std::abs(x) < 0.005 ? 0 : x; };
  out << "[" << rounded(v.x()) << ", " << rounded(v.y()) << ", " << rounded(v.z()) << "]";
  return out.str();
}

// --- the renderer ---

std::string how_to_get_normals(const ExperimentConfiguration& configuration, bool image) {
  if (image) return "add depth_pipeline (--set depth_pipeline={})";
  if (setting<bool>(*configuration.scenario.factory, "normals")) return "add scenario.normals = true";
  return "expected a scenario with normals, such as moving-plane, or with depth images and a depth_pipeline";
}

bool has_regions(const ExperimentConfiguration& configuration) {
  const std::vector<FixtureValues> all = configuration.fixture_values();
  return std::any_of(all.begin(), all.end(), [](const FixtureValues& values) {
    return values.role == FixtureRole::guidance || values.radius_m > 0;
  });
}

void check_regions(const ExperimentConfiguration& configuration, bool own_regions) {
  if (!own_regions && !has_regions(configuration))
    throw InputError(subject(configuration.renderer.name),
                     "needs forbidden regions: add a fixture rule with radius_m above 0 "
                     "(--set 'fixtures=[{\"name\": \"everywhere\", \"radius_m\": 0.01}]')");
}

void check_renderer(const ExperimentConfiguration& configuration, const std::vector<FrameNeed>& needs,
                    const FrameContents& given) {
  const std::string& name = configuration.renderer.name;
  const bool normals = given.normals || (configuration.depth_pipeline && given.image);
  if (contains(needs, FrameNeed::normals) && !normals)
    throw InputError(subject(name), "needs normals, and the points of the frames have none: " +
                                        how_to_get_normals(configuration, given.image));
  if (contains(needs, FrameNeed::organised) && !given.organised)
    throw InputError(subject(name),
                     "needs organised points, and those of the frames have no rows and columns: expected "
                     "depth images, or an organised cloud (of a PCD file: HEIGHT above 1)");
}

// --- the view direction of the sensor ---

// Throws InputError if the view direction still has its default value but the sensor of the recording looks
// in another direction. The default is right for scenes whose y axis is up. A direction that the user has set
// is trusted, because the points need not be in the axes of a camera.
void check_view(const std::string& path, const Vec3& view, const Vec3& by_default, const Scenario& scenario) {
  constexpr double kMinCosine = 0.5;  // surfaces that face the one direction mostly face the other
  const std::optional<RigidTransform> sensor = scenario.sensor_pose();
  if (!sensor || view != by_default) return;
  const Vec3 looks_W = sensor->linear().col(2);
  if (view.normalized().dot(looks_W) < kMinCosine)
    throw InputError(
        path + " = " + text(view),
        "the frames of this recording are not images, so the direction of the sensor must be given: "
        "expected the direction in which it looks, " +
            text(looks_W) + " in the axes of a camera");
}

// Throws InputError if the plane of a guidance target is needed and the sensor is not known to be at the
// origin. The normal of the plane points towards the sensor, which is assumed at the origin for frames that
// are not images.
void check_plane(const ExperimentConfiguration& configuration, const Scenario& scenario) {
  if (!configuration.guidance || configuration.guidance->orientation != GuidedOrientation::plane) return;
  const std::optional<RigidTransform> sensor = scenario.sensor_pose();
  if (!sensor || !sensor->translation().isZero(0))
    throw InputError("guidance.orientation = \"plane\"",
                     "needs to know where the sensor is, and the frames are not images: "
                     "expected depth images, or orientation = fixed");
}

Vec3 default_view(const ExperimentConfiguration& configuration) {
  const auto defaults = entry_of(configuration).make();
  return *setting<Vec3>(*defaults, "view_direction");
}

// Checks the settings that replace the information of an image layout.
void check_without_image(const ExperimentConfiguration& configuration, const std::vector<FrameNeed>& needs,
                         const Scenario& scenario) {
  if (contains(needs, FrameNeed::view))
    if (const Vec3* const view = setting<Vec3>(*configuration.renderer.factory, "view_direction"))
      check_view("renderer.view_direction", *view, default_view(configuration), scenario);
  if (configuration.faults && use_view_direction(*configuration.faults))
    check_view("faults.view_direction", configuration.faults->view_direction, SensorFaults{}.view_direction,
               scenario);
  check_plane(configuration, scenario);
}

bool may_have_normals(const PointCloud& cloud) {
  bool measured = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    if (cloud.normal(i).allFinite()) return true;
    measured = true;
  }
  return !measured;
}

// Returns the first cloud that has points; one without points if there are none among the first frames.
PointCloud first_with_points(const Scenario& scenario) {
  constexpr int kMaxFrames = 100;
  PointCloud cloud;
  for (int frame = 0; cloud.size() == 0 && frame < std::min(scenario.frame_count(), kMaxFrames); ++frame)
    cloud = scenario.cloud(frame);
  return cloud;
}

}  // namespace

// The hash includes the time of capture: the same points with another time stamp are another frame.
std::uint64_t frame_hash(const PointCloud& cloud, double captured_s) {
  return mixed(points_hash(cloud), std::bit_cast<std::uint64_t>(captured_s));
}

void FrameProcessing::fill(Frame& frame, PointCloud cloud, std::uint64_t off) const {
  if (depth) {
    if (!cloud.image)
      throw InputError("depth_pipeline", "this scenario's frames are not depth images: expected none");
    const std::optional<HueSteps> steps = fixtures.hue_steps(frame.captured_s, off);
    if (steps && depth->process_all(cloud, *steps)) {
      frame.points = make_search(std::move(cloud));
      return;
    }
    depth->process(cloud);
  }
  apply_fixtures(frame, std::move(cloud), off);
}

void FrameProcessing::fill(Frame& frame, const SensorFrame& sensed, const SensorView& view,
                           const RigidTransform& X_WC, std::uint64_t off) const {
  if (depth && !view.cloud) {
    const std::optional<HueSteps> steps = fixtures.hue_steps(frame.captured_s, off);
    PointCloud cloud;
    if (depth->process_all({sensed.depth.data(), view.metres_per_unit, view.camera, X_WC, sensed.colour},
                           cloud, steps ? &*steps : nullptr)) {
      if (steps)  // there are no targets, because all rules are forbidden regions
        frame.points = make_search(std::move(cloud));
      else
        apply_fixtures(frame, std::move(cloud), off);
      return;
    }
  }
  fill(frame, cloud_of(sensed, view, X_WC), off);
}

// Adds the number of the frame to the error of a rule. A rule refuses a frame that lacks the colours which it
// needs, but it does not know the number of the frame.
void FrameProcessing::apply_fixtures(Frame& frame, PointCloud cloud, std::uint64_t off) const {
  try {
    frame.guidance = fixtures.targets(cloud, frame.captured_s);
    fixtures.assign(cloud, frame.captured_s, off);
  } catch (const InputError& error) {
    throw InputError("frame " + std::to_string(frame.index), error.what());
  }
  frame.points = make_search(std::move(cloud));
}

FrameStream::FrameStream(const Scenario& scenario, FrameProcessing processing, const Transport& transport,
                         const NoiseKey& key, bool hash_frames, bool generate_all_points)
    : scenario_(scenario),
      truth_(std::make_shared<ScenarioTruth>(scenario)),
      processing_(std::move(processing)),
      transport_(transport),
      key_(key),
      hash_frames_(hash_frames),
      generate_all_points_(generate_all_points) {}

// The camera continues at its rate after the last frame of the scenario, and repeats that frame: only so does
// a renderer see that a surface which moved is at rest. The only frame of a scene shows no motion, so it is
// repeated only if a repetition can come earlier, come in its place, or show other fixtures.
bool FrameStream::exists(int frame) const {
  const int count = scenario_.frame_count();
  if (frame < count) return true;
  const bool matters = count > 1 || processing_.fixtures.changes_with_time() ||
                       transport_.drop_probability > 0 || transport_.jitter_s > 0;
  return matters && !scenario_.ends();
}

int FrameStream::source_frame(int frame) const {
  return std::min(frame, scenario_.frame_count() - 1);
}

double FrameStream::captured_s(int frame) const {
  return scenario_.captured_s(source_frame(frame)) +
         (frame - source_frame(frame)) / scenario_.frame_rate_hz();
}

void FrameStream::send(int frame) {
  const auto chance = uniforms(noise_stream(key_, NoiseUse::transport, static_cast<std::uint32_t>(frame)), 0);
  if (chance[0] < transport_.drop_probability) return;
  std::optional<double> delayed_leave_s;  // time at which the frame leaves the sensor, if not at its capture
  if (frame == source_frame(frame)) delayed_leave_s = scenario_.delivery(frame).leaves_sensor_s;
  const double leaves_sensor_s = delayed_leave_s.value_or(captured_s(frame));
  const FrameInTransit sent{leaves_sensor_s + transport_.latency_s + chance[1] * transport_.jitter_s, frame};
  const auto after = [](const FrameInTransit& a, const FrameInTransit& b) {
    return a.arrives_s < b.arrives_s;
  };
  in_transit_.insert(std::upper_bound(in_transit_.begin(), in_transit_.end(), sent, after), sent);
}

void FrameStream::deliver_until(double time_s, FrameReceiver& receiver) {
  const double now_s = time_s + kSameTime_s;
  while (exists(next_) && captured_s(next_) + transport_.latency_s <= now_s) send(next_++);
  while (!in_transit_.empty() && in_transit_.front().arrives_s <= now_s) {
    const FrameInTransit arrived = in_transit_.front();
    in_transit_.erase(in_transit_.begin());
    Frame frame{arrived.frame, captured_s(arrived.frame), arrived.arrives_s, nullptr};
    frame.truth = truth_;
    fill(frame);
    processing_.needs.check(frame);
    if (hash_frames_) hash_ = hash_of(arrived.frame, *frame.points);
    receiver.on_frame(frame);
  }
}

void FrameStream::fill(Frame& frame) {
  const int source = source_frame(frame.index);
  if (processing_.changes_points())
    processing_.fill(frame, scenario_.cloud(source),
                     scenario_.delivery(frame.index).fixtures_off.value_or(processing_.fixtures.off()));
  else if (frame.index > source && repeated_)
    frame.points = repeated_;
  else
    frame.points = points_of(source);
  if (frame.index > source) repeated_ = frame.points;
}

std::shared_ptr<const NeighbourSearch> FrameStream::points_of(int source) const {
  auto points = scenario_.points(source);
  if (!generate_all_points_ || points->stored_cloud()) return points;
  return make_search(scenario_.cloud(source));
}

std::uint64_t FrameStream::hash_of(int frame, const NeighbourSearch& points) const {
  const PointCloud* const stored = points.stored_cloud();
  return frame_hash(stored ? *stored : scenario_.cloud(source_frame(frame)), captured_s(frame));
}

std::vector<FrameNeed> renderer_needs(const ExperimentConfiguration& configuration) {
  return entry_of(configuration).needs;
}

void RendererNeeds::check(const Frame& frame) const {
  if (needs_.empty() || frame.points->size() == 0) return;
  const std::string number = std::to_string(frame.index);
  if (contains(needs_, FrameNeed::organised) &&
      !is_organised(frame.points->organised_columns(), frame.points->size()))
    throw InputError(subject(renderer_), "needs organised points, and those of frame " + number +
                                             " have no rows and columns: expected the same kind of cloud in "
                                             "every frame");
  if (!contains(needs_, FrameNeed::normals)) return;
  const PointCloud* const stored = frame.points->stored_cloud();
  if (!stored || !stored->has_normals())
    throw InputError(subject(renderer_), "needs normals, and the points of frame " + number +
                                             " have none: expected them in every frame");
  if (frame.index == 0 && !may_have_normals(*stored))
    throw InputError(subject(renderer_),
                     "needs normals, and no point of frame 0 has one: expected more points within "
                     "depth_pipeline.normal_radius_m of each");
}

void check_needs(const ExperimentConfiguration& configuration, const FixtureAssignment& fixtures,
                 const Scenario& scenario) {
  const std::vector<FrameNeed> needs = renderer_needs(configuration);
  const bool faults = configuration.faults && use_view_direction(*configuration.faults);
  if ((needs.empty() && fixtures.empty() && !faults) || scenario.frame_count() < 1) return;
  const PointCloud first = first_with_points(scenario.without_faults());
  if (contains(needs, FrameNeed::regions)) check_regions(configuration, !first.fixture_radius_m.empty());
  if (first.size() == 0) return;
  check_renderer(configuration, needs, contents_of(first));
  if (!first.image) check_without_image(configuration, needs, scenario);
  fixtures.require(first);
}

void check_needs(const ExperimentConfiguration& configuration, const SensorView& view) {
  const std::vector<FrameNeed> needs = renderer_needs(configuration);
  if (contains(needs, FrameNeed::regions)) check_regions(configuration, false);
  check_renderer(configuration, needs, contents_of(view));
}

}  // namespace remote_touch
