#include "runners/experiment/catalog/catalog.h"

#include "core/beyond/tracked_surface/tracked_renderers.h"
#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/implicit_surface_renderers.h"
#include "core/rivals/mls_surface_renderer.h"
#include "core/rivals/proxy_variants.h"
#include "core/rivals/rival_renderer.h"
#include "runners/experiment/hand/image_motions.h"
#include "runners/experiment/hand/trajectory.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "runners/experiment/sessions/session_scene.h"
#include "scenarios/recordings/recorded_scene.h"
#include "scenarios/simulated/camera_scenes.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/panel_scenes.h"
#include "scenarios/simulated/shape.h"

namespace remote_touch {

namespace {

std::vector<ScenarioEntry> built_in_scenarios() {
  return {
      scenario_entry<FlatGrid>("flat-grid", "a flat 100 x 100 cloud at rest, 4.3.1"),
      scenario_entry<MovingLift>("moving-lift",
                                 "a noisy flat 200 x 200 cloud that rises and accelerates, 4.3.2"),
      scenario_entry<MovingShape>(
          "moving-shape", "a plane, ridge, valley, ball or ripple that is lifted, slid, shaken or rocked"),
      scenario_entry<Plates>("plates",
                             "flat plates seen from above that hide each other, pass or move apart"),
      scenario_entry<TriangleWave>("triangle-wave",
                                   "a triangle wave of growing height at rest, with sharp edges, 4.3.3"),
      scenario_entry<CameraScene>("camera-scene",
                                  "a simulated depth camera looks at a ramp and a box on a table, 4.3.4"),
      scenario_entry<ListedPoints>("points",
                                   "a list of points at rest; the default, one point, is the cloud of 5.3.1"),
      scenario_entry<BeatingHeart>("beating-heart",
                                   "a simulated depth camera looks down on a beating organ on a table"),
      scenario_entry<ValveTank>(
          "valve-tank", "a simulated colour and depth camera looks at two valves in turbid water, 7.5.1"),
      scenario_entry<OpenBox>("box", "a box open at the top, seen from inside, 6.3.1"),
      scenario_entry<Slot>("slot", "two parallel walls: a bar turned between them stops at a known angle"),
      scenario_entry<Wedge>("wedge", "two inclined walls that close on a tool and open again"),
      scenario_entry<MovingPlane>("moving-plane",
                                  "a flat cloud with normals that waits, then rises and lifts a tool"),
      scenario_entry<SinglePanel>("panel", "one flat panel with normals that can be touched from both sides"),
      scenario_entry<RecordingWithTruth>("recording",
                                         "a recorded sequence of depth images or organised clouds"),
      scenario_entry<MeshSceneFromFiles>(
          "mesh-scene", "a simulated depth camera looks at meshes of the user, at rest or on paths of poses"),
      scenario_entry<SessionScene>(
          "live-session",
          "the frames of a recorded live session, at the times when the live renderer received them"),
  };
}

std::vector<FixtureEntry> built_in_fixtures() {
  return {
      fixture_entry<Everywhere>("everywhere", "selects every point, 5.3.3"),
      fixture_entry<HalfSpace>("half-space", "selects the points on one side of a plane, 5.3.2"),
      fixture_entry<NearPoint>(
          "near-point", "selects the points near a given position, or near the point that a pixel sees"),
      fixture_entry<HueRange>("hue-range", "selects the points of a colour (a range of hues)"),
      fixture_entry<ImageMask>("image-mask", "selects the points whose pixels a mask image marks"),
  };
}

std::vector<TrajectoryEntry> built_in_trajectories() {
  return {
      trajectory_entry<Waypoints>("waypoints",
                                  "a list of positions, each with the speed of the motion to it"),
      trajectory_entry<Poses>(
          "poses", "a list of poses (position and orientation), each with the duration of the motion to it"),
      trajectory_entry<SessionHand>("live-session",
                                    "the motion of the hand in a recorded live session, tick by tick", true),
      trajectory_entry<RandomMotion>("random-motion", "a smooth random motion with six degrees of freedom"),
      trajectory_entry<Press>("press", "waits, then presses to a given depth below the surface, 4.3.2"),
      trajectory_entry<FollowSurface>("follow-surface",
                                      "moves along a line at a given depth below the true surface"),
      trajectory_entry<ContactReplay>(
          "contact-replay", "replays a contact whose force is known, from a file or over the true surface"),
      trajectory_entry<ImageScan>(
          "image-scan", "moves along an image row at a given depth behind the surface of the first frame"),
      trajectory_entry<ImagePress>(
          "image-press", "presses at one pixel, at a given depth behind the surface of the newest frame"),
  };
}

std::vector<RendererEntry> built_in_renderers() {
  return {
      renderer_entry<ProxyRenderer, ProxyParameters>("proxy", DegreesOfFreedom::three,
                                                     "3-DOF point cloud proxy, chapters 4 and 5"),
      renderer_entry<TrackedSheetRenderer, TrackedSheetParameters>(
          "tracked-sheet", DegreesOfFreedom::three,
          "3-DOF proxy on a surface that is tracked from frame to frame and denoised; beyond the dissertation"),
      renderer_entry<PenaltyRenderer, PenaltyParameters>(
          "penalty", DegreesOfFreedom::three,
          "3-DOF method for comparison: direct (penalty) rendering, a spring without a proxy"),
      renderer_entry<ImplicitSurfaceRenderer, ImplicitSurfaceParameters>(
          "implicit-surface", DegreesOfFreedom::three,
          "3-DOF method for comparison: a proxy on an implicit surface, Leeper, Chan and Salisbury 2012 [84]"),
      renderer_entry<SurfelRenderer, SurfelParameters>(
          "surfels", DegreesOfFreedom::three,
          "3-DOF method for comparison: a proxy on surfels with normals towards the sensor, after the program of [84]",
          {FrameNeed::view}),
      renderer_entry<MlsSurfaceRenderer, MlsSurfaceParameters>(
          "mls-surface", DegreesOfFreedom::three,
          "3-DOF method for comparison: a proxy on a moving least squares surface, Alexa 2003 and Adamson 2003",
          {FrameNeed::view}),
      renderer_entry<AveragedProxyRenderer, AveragedProxyParameters>(
          "averaged-proxy", DegreesOfFreedom::three,
          "3-DOF method for comparison: the proxy of chapter 4 on points averaged over the last frames",
          {FrameNeed::view}),
      renderer_entry<DensityProxyRenderer, DensityProxyParameters>(
          "density-proxy", DegreesOfFreedom::three,
          "3-DOF method for comparison: the proxy of chapter 4, its radius adapted to the density of the points"),
      renderer_entry<OracleProxyRenderer, OracleProxyParameters>(
          "oracle-proxy", DegreesOfFreedom::three,
          "3-DOF oracle, simulations only: the proxy of chapter 4, given the true velocity of the surface"),
      renderer_entry<GodObjectRenderer, GodObjectParameters>(
          "god-object", DegreesOfFreedom::three,
          "3-DOF method for comparison: a god-object on the mesh of an organised frame, Zilles and Salisbury 1995",
          {FrameNeed::organised}),
      renderer_entry<LoadedTool, LoadedTool::Settings>(
          "tool", DegreesOfFreedom::six, "6-DOF rendering of a rigid tool, chapter 6", {FrameNeed::normals}),
      renderer_entry<LoadedTrackedTool, LoadedTrackedTool::Settings>(
          "tracked-tool", DegreesOfFreedom::six,
          "6-DOF rendering of a rigid tool on surfaces that are tracked from frame to frame and denoised; beyond the dissertation",
          {FrameNeed::normals}),
      renderer_entry<LoadedToolPenalty, LoadedToolPenalty::Settings>(
          "tool-penalty", DegreesOfFreedom::six,
          "6-DOF method for comparison: points push a tool that nothing constrains, McNeely, Puterbaugh and Troy 1999"),
      renderer_entry<LoadedToolGodObject, LoadedToolGodObject::Settings>(
          "tool-god-object", DegreesOfFreedom::six,
          "6-DOF method for comparison: a god-object held by the contacts of its pose, Ortega, Redon and Coquillart 2007"),
      renderer_entry<LoadedToolInnerSpheres, LoadedToolInnerSpheres::Settings>(
          "tool-inner-spheres", DegreesOfFreedom::six,
          "6-DOF method for comparison: the volume of inner spheres behind the points pushes a tool, Weller and Zachmann 2009, Kaluschke et al. 2017"),
      renderer_entry<LoadedSpheres, LoadedSpheres::Settings>(
          "sphere-tree", DegreesOfFreedom::six,
          "6-DOF forbidden regions: a tool made of spheres is kept out of the balls around points, chapter 7",
          {FrameNeed::regions}),
  };
}

template <class Entry>
void add_new(std::span<const Entry> entries, std::span<const Entry> known, Catalog& own) {
  for (const Entry& entry : entries)
    if (std::ranges::none_of(known, [&](const Entry& other) { return other.name == entry.name; }))
      own.add(entry);
}

Catalog built_in_entries() {
  Catalog catalog;
  for (ScenarioEntry& entry : built_in_scenarios()) catalog.add(std::move(entry));
  for (FixtureEntry& entry : built_in_fixtures()) catalog.add(std::move(entry));
  for (TrajectoryEntry& entry : built_in_trajectories()) catalog.add(std::move(entry));
  for (RendererEntry& entry : built_in_renderers()) catalog.add(std::move(entry));
  for (const Measure& measure : built_in_measures()) catalog.add(measure);
  return catalog;
}

// The catalog that use_catalog() has set; none before its first call.
std::optional<Catalog>& chosen_catalog() {
  static std::optional<Catalog> catalog;
  return catalog;
}

}  // namespace

// Throws InputError unless --set, lists and files can hold the name. Every entry must have such a name.
void Catalog::require_name(const std::string& kind, const std::string& name, bool is_taken) {
  if (name.empty() || name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") != std::string::npos)
    throw InputError(kind + " \"" + name + "\"", "expected a name of lower case letters, digits, - and _");
  if (is_taken) throw InputError(kind + " \"" + name + "\"", "is in the catalog already");
}

Catalog& Catalog::add(Measure measure) {
  if (!measure.compute) throw InputError("measure \"" + measure.name + "\"", "has no function");
  return append(measures_, std::move(measure), "measure");
}

const Catalog& built_in_catalog() {
  static const Catalog catalog = built_in_entries();
  return catalog;
}

bool Catalog::is_empty() const {
  return scenarios_.empty() && fixtures_.empty() && trajectories_.empty() && renderers_.empty() &&
         measures_.empty();
}

Catalog own_entries(const Catalog& catalog) {
  const Catalog& built_in = built_in_catalog();
  Catalog own;
  add_new(catalog.scenarios(), built_in.scenarios(), own);
  add_new(catalog.fixtures(), built_in.fixtures(), own);
  add_new(catalog.trajectories(), built_in.trajectories(), own);
  add_new(catalog.renderers(), built_in.renderers(), own);
  add_new(catalog.measures(), built_in.measures(), own);
  return own;
}

void use_catalog(Catalog catalog) {
  chosen_catalog() = std::move(catalog);
}

const Catalog& catalog_in_use() {
  return chosen_catalog() ? *chosen_catalog() : built_in_catalog();
}

std::span<const ScenarioEntry> scenarios() {
  return catalog_in_use().scenarios();
}
std::span<const FixtureEntry> fixtures() {
  return catalog_in_use().fixtures();
}
std::span<const TrajectoryEntry> trajectories() {
  return catalog_in_use().trajectories();
}
std::span<const RendererEntry> renderers() {
  return catalog_in_use().renderers();
}
std::span<const Measure> measures() {
  return catalog_in_use().measures();
}
Directions directions() {
  Directions all;
  for (const Measure& measure : measures()) all[measure.name] = measure.better;
  return all;
}

}  // namespace remote_touch
