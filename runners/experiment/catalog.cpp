#include "runners/experiment/catalog.h"

#include "core/proxy/proxy_renderer.h"
#include "core/rivals/averaged_proxy_renderer.h"
#include "core/rivals/density_proxy_renderer.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/implicit_surface_renderer.h"
#include "core/rivals/oracle_proxy_renderer.h"
#include "core/rivals/penalty_renderer.h"
#include "core/rivals/surfel_renderer.h"
#include "core/tracked_sheet/tracked_sheet_renderer.h"
#include "core/virtual_fixtures/everywhere.h"
#include "core/virtual_fixtures/half_space.h"
#include "core/virtual_fixtures/hue_range.h"
#include "core/virtual_fixtures/near_point.h"
#include "runners/experiment/renderer_contacts.h"
#include "runners/sessions/session_scene.h"
#include "runners/tool_files/loaded_spheres.h"
#include "runners/tool_files/loaded_tool.h"
#include "runners/trajectories/follow_surface.h"
#include "runners/trajectories/image_press.h"
#include "runners/trajectories/image_scan.h"
#include "runners/trajectories/poses.h"
#include "runners/trajectories/press.h"
#include "runners/trajectories/random_walk.h"
#include "runners/trajectories/waypoints.h"
#include "scenarios/camera/beating_heart.h"
#include "scenarios/camera/camera_scene.h"
#include "scenarios/camera/valve_tank.h"
#include "scenarios/recordings/image_mask.h"
#include "scenarios/recordings/recorded_scene.h"
#include "scenarios/synthetic/flat_grid.h"
#include "scenarios/synthetic/listed_points.h"
#include "scenarios/synthetic/moving_lift.h"
#include "scenarios/synthetic/moving_plane.h"
#include "scenarios/synthetic/moving_shape.h"
#include "scenarios/synthetic/open_box.h"
#include "scenarios/synthetic/plates.h"
#include "scenarios/synthetic/sheet.h"
#include "scenarios/synthetic/slot.h"
#include "scenarios/synthetic/triangle_wave.h"
#include "scenarios/synthetic/wedge.h"

namespace remote_touch {

namespace {

template <class Product, class Settings, class... Seam>
std::unique_ptr<Factory<Seam...>> factory() {
  return std::make_unique<FactoryFor<Product, Settings, Seam...>>();
}

template <class Product>
ScenarioEntry scenario(const char* name, const char* summary) {
  return {name, summary,
          factory<Product, typename Product::Settings, Scenario, const NoiseKey&, const Kernels&>};
}

template <class Product>
FixtureEntry fixture(const char* name, const char* summary) {
  return {name, summary, factory<Product, typename Product::Settings, FixtureRule>};
}

template <class Product>
TrajectoryEntry trajectory(const char* name, const char* summary, bool has_buttons = false) {
  return {{name, summary, factory<Product, typename Product::Settings, Trajectory, const Scenario&>},
          has_buttons};
}

template <class Product, class Settings>
RendererEntry renderer(const char* name, DegreesOfFreedom degrees_of_freedom, ContactModel contact_model,
                       const char* summary) {
  return {{name, summary, factory<Product, Settings, Renderer, double, const Kernels&>},
          degrees_of_freedom,
          contact_model};
}

const ScenarioEntry kScenarios[] = {
    scenario<FlatGrid>("flat-grid", "a flat 100 x 100 cloud at rest, 4.3.1"),
    scenario<MovingLift>("moving-lift", "a noisy flat 200 x 200 cloud that rises and accelerates, 4.3.2"),
    scenario<MovingShape>("moving-shape",
                          "a plane, ridge, valley, ball or ripple that is lifted, slid, shaken or rocked"),
    scenario<Plates>("plates", "flat plates seen from above that hide each other, pass or move apart"),
    scenario<TriangleWave>("triangle-wave",
                           "a triangle wave of growing height at rest, with sharp edges, 4.3.3"),
    scenario<CameraScene>("camera-scene",
                          "a simulated depth camera looks at a ramp and a box on a table, 4.3.4"),
    scenario<ListedPoints>("points",
                           "a list of points at rest; the default, one point, is the cloud of 5.3.1"),
    scenario<BeatingHeart>("beating-heart",
                           "a simulated depth camera looks down on a beating organ on a table"),
    scenario<ValveTank>("valve-tank",
                        "a simulated colour and depth camera looks at two valves in turbid water, 7.5.1"),
    scenario<OpenBox>("box", "a box open at the top, seen from inside, 6.3.1"),
    scenario<Slot>("slot", "two parallel walls: a bar turned between them stops at a known angle"),
    scenario<Wedge>("wedge", "two inclined walls that close on a tool and open again"),
    scenario<MovingPlane>("moving-plane",
                          "a flat cloud with normals that waits, then rises and lifts a tool"),
    scenario<Sheet>("sheet", "one flat panel with normals that can be touched from both sides"),
    scenario<RecordedScene>("recording", "a recorded sequence of depth images or organised clouds"),
    scenario<SessionScene>(
        "live-session",
        "the frames of a recorded live session, at the times when the live renderer received them"),
};

const FixtureEntry kFixtures[] = {
    fixture<Everywhere>("everywhere", "selects every point, 5.3.3"),
    fixture<HalfSpace>("half-space", "selects the points on one side of a plane, 5.3.2"),
    fixture<NearPoint>("near-point",
                       "selects the points near a given position, or near the point that a pixel sees"),
    fixture<HueRange>("hue-range", "selects the points of a colour (a range of hues)"),
    fixture<ImageMask>("image-mask", "selects the points whose pixels a mask image marks"),
};

const TrajectoryEntry kTrajectories[] = {
    trajectory<Waypoints>("waypoints", "a list of positions, each with the speed of the motion to it"),
    trajectory<Poses>(
        "poses", "a list of poses (position and orientation), each with the duration of the motion to it"),
    trajectory<SessionHand>("live-session", "the motion of the hand in a recorded live session, tick by tick",
                            true),
    trajectory<RandomWalk>("random-walk", "a smooth random motion with six degrees of freedom"),
    trajectory<Press>("press", "waits, then presses to a given depth below the surface, 4.3.2"),
    trajectory<FollowSurface>("follow-surface", "moves along a line at a given depth below the true surface"),
    trajectory<ImageScan>("image-scan",
                          "moves along an image row at a given depth behind the surface of the first frame"),
    trajectory<ImagePress>("image-press",
                           "presses at one pixel, at a given depth behind the surface of the newest frame"),
};

const RendererEntry kRenderers[] = {
    renderer<ProxyRenderer, ProxyParameters>("proxy", DegreesOfFreedom::three, ContactModel::points,
                                             "3-DOF point cloud proxy, chapters 4 and 5"),
    renderer<TrackedSheetRenderer, TrackedSheetParameters>(
        "tracked-sheet", DegreesOfFreedom::three, ContactModel::sheet,
        "3-DOF proxy on a surface that is tracked from frame to frame and denoised; beyond the dissertation"),
    renderer<PenaltyRenderer, PenaltyParameters>(
        "penalty", DegreesOfFreedom::three, ContactModel::nothing,
        "3-DOF method for comparison: direct (penalty) rendering, a spring without a proxy"),
    renderer<ImplicitSurfaceRenderer, ImplicitSurfaceParameters>(
        "implicit-surface", DegreesOfFreedom::three, ContactModel::points,
        "3-DOF method for comparison: a proxy on an implicit surface, Leeper, Chan and Salisbury 2012 [84]"),
    renderer<SurfelRenderer, SurfelParameters>(
        "surfels", DegreesOfFreedom::three, ContactModel::oriented,
        "3-DOF method for comparison: a proxy on surfels with normals towards the sensor, after the program of [84]"),
    renderer<AveragedProxyRenderer, AveragedProxyParameters>(
        "averaged-proxy", DegreesOfFreedom::three, ContactModel::oriented,
        "3-DOF method for comparison: the proxy of chapter 4 on points averaged over the last frames"),
    renderer<DensityProxyRenderer, DensityProxyParameters>(
        "density-proxy", DegreesOfFreedom::three, ContactModel::points,
        "3-DOF method for comparison: the proxy of chapter 4, its radius adapted to the density of the points"),
    renderer<OracleProxyRenderer, OracleProxyParameters>(
        "oracle-proxy", DegreesOfFreedom::three, ContactModel::points,
        "3-DOF oracle, simulations only: the proxy of chapter 4, told the true velocity of the surface"),
    renderer<GodObjectRenderer, GodObjectParameters>(
        "god-object", DegreesOfFreedom::three, ContactModel::mesh,
        "3-DOF method for comparison: a god-object on the mesh of an organised frame, Zilles and Salisbury 1995"),
    renderer<LoadedTool, LoadedTool::Settings>("tool", DegreesOfFreedom::six, ContactModel::points,
                                               "6-DOF rendering of a rigid tool, chapter 6"),
    renderer<LoadedToolPenalty, LoadedToolPenalty::Settings>(
        "tool-penalty", DegreesOfFreedom::six, ContactModel::points,
        "6-DOF method for comparison: points push a tool that nothing constrains, McNeely, Puterbaugh and Troy 1999"),
    renderer<LoadedSpheres, LoadedSpheres::Settings>(
        "sphere-tree", DegreesOfFreedom::six, ContactModel::regions,
        "6-DOF forbidden regions: a tool made of spheres is kept out of the balls around points, chapter 7"),
};

}  // namespace

std::span<const ScenarioEntry> scenarios() {
  return kScenarios;
}
std::span<const FixtureEntry> fixtures() {
  return kFixtures;
}
std::span<const TrajectoryEntry> trajectories() {
  return kTrajectories;
}
std::span<const RendererEntry> renderers() {
  return kRenderers;
}

}  // namespace remote_touch
