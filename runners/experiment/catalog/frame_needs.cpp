#include "runners/experiment/catalog/frame_needs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/configuration.h"

namespace remote_touch {

namespace {

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

}  // namespace

namespace {

// Returns the first cloud that has points; one without points if there are none among the first frames.
PointCloud first_with_points(const Scenario& scenario) {
  constexpr int kMaxFrames = 100;
  PointCloud cloud;
  for (int frame = 0; cloud.size() == 0 && frame < std::min(scenario.frame_count(), kMaxFrames); ++frame)
    cloud = scenario.cloud(frame);
  return cloud;
}

}  // namespace

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
  const auto* const stored = dynamic_cast<const CloudSearch*>(frame.points.get());
  if (!stored || !stored->cloud().has_normals())
    throw InputError(subject(renderer_), "needs normals, and the points of frame " + number +
                                             " have none: expected them in every frame");
  if (frame.index == 0 && !may_have_normals(stored->cloud()))
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
