#include "runners/catalog.h"

#include "core/proxy_renderer.h"
#include "runners/trajectories/follow_surface.h"
#include "runners/trajectories/image_press.h"
#include "runners/trajectories/image_scan.h"
#include "runners/trajectories/press.h"
#include "runners/trajectories/waypoints.h"
#include "scenarios/camera_scene.h"
#include "scenarios/flat_grid.h"
#include "scenarios/moving_lift.h"
#include "scenarios/recorded_scene.h"
#include "scenarios/triangle_wave.h"

namespace remote_touch {

namespace {

template <class Product, class Settings, class... Seam>
std::unique_ptr<Blueprint<Seam...>> blueprint() {
  return std::make_unique<BlueprintFor<Product, Settings, Seam...>>();
}

template <class Product>
ScenarioEntry scenario(const char* name, const char* summary) {
  return {name, summary,
          blueprint<Product, typename Product::Settings, Scenario, const NoiseKey&, const Kernels&>};
}

template <class Product>
TrajectoryEntry trajectory(const char* name, const char* summary) {
  return {name, summary, blueprint<Product, typename Product::Settings, Trajectory, const Scenario&>};
}

template <class Product, class Settings>
RendererEntry renderer(const char* name, const char* summary) {
  return {name, summary, blueprint<Product, Settings, Renderer, double, const Kernels&>};
}

const ScenarioEntry kScenarios[] = {
    scenario<FlatGrid>("flat-grid", "a flat 100 x 100 cloud that rests, 4.3.1"),
    scenario<MovingLift>("moving-lift", "a noisy flat 200 x 200 cloud that rises and accelerates, 4.3.2"),
    scenario<TriangleWave>("triangle-wave", "sharp edges of growing height, 4.3.3"),
    scenario<CameraScene>("camera-scene",
                          "a simulated depth camera looks at a ramp and a box on a table, 4.3.4"),
    scenario<RecordedScene>("recording", "a recorded sequence of depth images or organised clouds"),
};

const TrajectoryEntry kTrajectories[] = {
    trajectory<Waypoints>("waypoints", "listed points, each with its speed"),
    trajectory<Press>("press", "wait, then press a set depth into the surface, 4.3.2"),
    trajectory<FollowSurface>("follow-surface", "along a line, a set depth below the true surface"),
    trajectory<ImageScan>("image-scan", "along an image row, a set depth behind the first frame's surface"),
    trajectory<ImagePress>("image-press",
                           "where a pixel looks, a set depth behind the newest frame's surface"),
};

const RendererEntry kRenderers[] = {
    renderer<ProxyRenderer, ProxyParameters>("proxy", "3-DOF point cloud proxy, chapter 4"),
};

}  // namespace

std::span<const ScenarioEntry> scenarios() {
  return kScenarios;
}
std::span<const TrajectoryEntry> trajectories() {
  return kTrajectories;
}
std::span<const RendererEntry> renderers() {
  return kRenderers;
}

}  // namespace remote_touch
