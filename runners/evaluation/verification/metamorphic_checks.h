// Metamorphic tests of a renderer, which need no reference solution: each scene is played unchanged and
// transformed, and the two outputs must be related as metamorphic_relation.cpp defines. They use only the
// interface Renderer, so every new renderer of the catalog is checked without further work.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/catalog/catalog.h"

namespace remote_touch {

// The scenes as plain data: those in which every renderer is checked, and those for tools.

// One frame of the stream.
struct CloudView {
  int index = 0;
  double captured_s = 0;
  double arrives_s = 0;
  PointCloud cloud;
};

// A stream of clouds and a path of the HIP as plain data, so that both can be rotated, scaled, reordered or
// delayed before they are played again. World frame, metres, seconds.
struct MetamorphicScene {
  std::string name;
  std::string what;  // one line
  double haptic_rate_hz = 0;
  double start_s = 0;            // time of the first tick
  std::vector<CloudView> views;  // views in the order of their arrival
  std::vector<Vec3> hip_W;       // HIP in each tick
  // Orientation of the device in each tick: transforms directions from its handle to the world frame.
  std::vector<Eigen::Quaterniond> device_WH;
  bool cloud_rests = false;  // every view shows the same points
  bool hip_rests = false;    // the HIP is at rest before the second view arrives, and stays there
  bool has_crease = false;   // walls meet, which a fitted sheet rounds off
  // Cell size of the grid in which points are searched; 0: brute force. An organised cloud is searched by its
  // image instead.
  double cell_m = 0.004;

  double time_s(std::size_t tick) const { return start_s + static_cast<double>(tick) / haptic_rate_hz; }
};

// One output for each tick.
std::vector<RenderOutput> play(const MetamorphicScene& scene, Renderer& renderer);

// Returns the scenes in which renderers of a tool are checked, like verification_scenes(), with normals and a
// device that turns, for the tool kVerifiedTool. Points have regions in the scenes for renderers of regions.
std::vector<MetamorphicScene> tool_scenes(const Kernels& kernels);

// A bar of 80 x 20 x 10 mm, which is its own mirror image along every axis. Written as assignments. The
// voxels are coarse, because the tool is made or loaded for every check.
inline constexpr const char* kVerifiedTool[] = {"tool_mesh=bar", "tool_size_m=0.08", "tool_voxel_m=0.001"};

// Returns the scenes in which every renderer is checked: 320 ticks at 1024 Hz each, with clouds at 32 Hz that
// arrive 5 ticks late: all times are whole multiples of 1/1024 s, so they stay exact when they are halved or
// shifted by whole seconds. A proxy of about 5 mm on points 1.5 mm apart is pressed most of the time. Every
// surface is tilted and every point displaced from its lattice, so that no comparison in a renderer is a tie
// that rounding decides. The same bits on every machine and for all kernels.
std::vector<MetamorphicScene> verification_scenes(const Kernels& kernels);

// A contact model says which checks of the contract tests and of `verify` apply to a renderer. It does not
// change runs. All values are false for a proxy that is held by all points of a cloud and by the forbidden
// regions around them: every check applies to it. Each true value changes or omits checks.
struct ContactModel {
  // The contract tests give every point a region; `verify` gives a tool only scenes with regions, and mirrors
  // none.
  bool renders_only_regions = false;
  // Points only push: three contract tests hold the HIP 2 to 3 mm above the points.
  bool pressed_hip_passes_through = false;
  bool may_lose_contact = false;        // `touch` asks for a force in 2 % of the ticks, not in half of them
  bool depends_on_point_order = false;  // `verify` does not reorder the points
  bool uses_camera = false;  // `verify` keeps the image layout, which gives the direction to the sensor
  // `verify` does not mirror the scene. It moves only images of a renderer that uses the camera, and doubles
  // the frame rate only if the renderer uses the camera.
  bool depends_on_axes = false;
  bool smooths_creases = false;  // `verify` gives a tool no scene in which walls meet
  // `verify` gives a tool no moving cloud, because rounding decides when the surface passes through the tool.
  bool motion_amplifies_rounding = false;

  // The named models. The name says what holds the proxy; runners/interfaces/plugins/remote_touch_plugin.h
  // gives reasons.
  // NOLINTNEXTLINE(readability-identifier-naming): these are the names of plug-ins and Python.
  static const ContactModel points, regions, mesh, sheet, nothing, oriented, resting_points;
};
inline constexpr ContactModel ContactModel::points{};
inline constexpr ContactModel ContactModel::regions{.renders_only_regions = true};
inline constexpr ContactModel ContactModel::mesh{.may_lose_contact = true, .depends_on_point_order = true};
inline constexpr ContactModel ContactModel::sheet{.depends_on_axes = true, .smooths_creases = true};
inline constexpr ContactModel ContactModel::nothing{.pressed_hip_passes_through = true,
                                                    .may_lose_contact = true};
inline constexpr ContactModel ContactModel::oriented{
    .may_lose_contact = true, .uses_camera = true, .depends_on_axes = true};
inline constexpr ContactModel ContactModel::resting_points{.motion_amplifies_rounding = true};

// The named models, indexed by their number in plug-ins. Python lists the names in the same order.
inline constexpr ContactModel kContactModels[] = {
    ContactModel::points,  ContactModel::regions,  ContactModel::mesh,          ContactModel::sheet,
    ContactModel::nothing, ContactModel::oriented, ContactModel::resting_points};

// Returns the model that is declared for the renderer of that name; `points` if none is.
ContactModel contact_model_of(const std::string& renderer);

// Declares the model of a renderer of a plug-in, of Python or of a program, in place of an earlier one. Has
// no effect on a built-in renderer.
void declare_contact_model(const std::string& renderer, const ContactModel& model);

// The dimensions of a renderer's parameters, from the unit that ends their names, so that a scene and a
// renderer can be converted together to other units of length, time and force.

// Factors by which every length, time and force is multiplied.
struct UnitChange {
  double length = 1;
  double time = 1;
  double force = 1;

  double factor(const Dimension& dimension) const;  // exact if the changes are powers of two
};

// Returns the dimension of a number with that name. "r1_m" is {1, 0, 0} and "damping_Ns_per_m" is {-1, 1, 1}.
// "gamma" has no underscore and is a pure number. Throws InputError, about that name, for an ending that is
// not in known_units(): a wrong guess would make every check by units worthless.
Dimension dimension_of(const std::string& name);

// Multiplies every number by its factor, each column of Rows by its own. Choices, texts, switches and
// integers are not changed. Throws InputError for a name without a known dimension, an integer that would
// have to change, and a number that leaves its allowed range.
void change_units(const Parameters& parameters, const UnitChange& change);

// Returns the largest magnitude of the parameters that are lengths, m; 0 if no parameter is a length.
double max_length_m(const Parameters& parameters);

// A transformed scene together with the outputs that a renderer must then give. Starts as the scene and the
// outputs of its reference run. The functions below change the scene, and the expected outputs if these must
// change with it.
struct Variation {
  MetamorphicScene scene;
  std::vector<RenderOutput> expected;  // output of each tick
  const Kernels* kernels = nullptr;
  UnitChange units = {};            // change of the renderer's parameters
  bool until_velocity = false;      // compare only until either run has estimated a surface velocity
  double reach_m = 0;               // the renderer's largest length
  ContactModel contact_model = {};  // the renderer's
  bool can_be_mirrored = true;      // false: a tool of unknown shape, or of regions
  std::optional<double> stiffness_N_per_m = {};  // parameter of the renderer, if it has one of that name
  std::optional<double> other_stiffness_N_per_m = {};  // replaces it in the varied run
};

// Multiplies lengths, times and forces, including parameters and k_s of points, by their factors.
void change_units(Variation& variation, const UnitChange& change);

// Moves cloud, camera and path as one rigid body.
void move_rigidly(Variation& variation, const RigidTransform& motion);

// Changes the sign of one coordinate, axis 0 to 2. A tool must be its own mirror image. An image layout
// cannot be mirrored, so the cloud is searched by a grid afterwards.
void mirror(Variation& variation, int axis);

// Replaces the search by that of a grid, or by brute force for cell_m = 0. An organised cloud keeps only the
// number of columns of its layout.
void replace_search(Variation& variation, double cell_m);

// Rebuilds every cloud from the points with the numbers order[0], order[1], ...; -1 stands for a point that
// was not measured. pre: no cloud is an image, see replace_search(). The points are no longer organised.
void reorder(Variation& variation, const std::function<std::vector<int>(int size)>& order);

// Adds points to every cloud, with the columns that it has: r_f = 0, and the cloud's first stiffness.
void add_points(Variation& variation, const std::vector<Vec3>& points_W);

// Inserts a view after each view from index `first` on, which arrives `ticks` later. make() derives it from
// that view and the view before it (itself for the first). Returns the positions of the inserted views in the
// stream.
std::vector<std::size_t> follow_views(
    Variation& variation, std::size_t first, int ticks,
    const std::function<CloudView(const CloudView& view, const CloudView& previous)>& make);

// Relations that must hold for every haptic renderer when its input is transformed. They need no reference
// solution: the renderer's own output for the unchanged scene determines the expected one.

// Allowed differences between two runs. 0 everywhere: equal bits, except for the sign of a zero.
struct OutputTolerance {
  double position_m = 0;
  double force_fraction = 0;  // fraction of the largest force in the run
  double velocity_m_per_s = 0;
  double normal = 0;
  bool rounded = false;        // true: steps are not compared, and normals only while a point is touched
  double rotation_rad = 0;     // rotation of a tool
  double torque_fraction = 0;  // fraction of the largest torque in the run
  // true: the nearest distance, the normal and "other" are not compared; the depth in a tool still is.
  bool without_contact_details = false;
};

struct MetamorphicRelation {
  const char* name;
  const char* meaning;  // one line
  OutputTolerance tolerance;
  const char* reason;            // reason for the tolerance, one line
  bool (*vary)(Variation& run);  // false: does not apply to this scene
};

// A renderer of six degrees of freedom, of a tool, has relations and tolerances of its own.
std::vector<MetamorphicRelation> relations_of(DegreesOfFreedom degrees_of_freedom);

// The largest difference of one kind.
struct Deviation {
  // "position" (proxy, slave, frame correction), "nearest" (nearest distance, and penetration of a tool),
  // "force", "velocity", "normal", "rotation" and "torque" of a tool, or "other": 1 if state, convergence,
  // steps, counts, frame or status differ.
  const char* quantity;
  const char* unit;
  double tolerance = 0;
  double max = 0;  // infinite if only one of the two is a finite number
};

struct Comparison {
  std::vector<Deviation> deviations;
  int first_violation = -1;  // the tick; -1: none
  int ticks = 0;             // number of ticks that were compared
};

// One check in one scene.
struct CheckResult {
  std::string check;
  std::string meaning;  // one line
  std::string scene;
  std::string reason;  // reason for the tolerances, one line
  Comparison comparison;
  std::string remark;  // set for a failure that the scene may cause and not the renderer; else empty

  bool passed() const { return comparison.ticks > 0 && comparison.first_violation < 0; }
};

// Returns all results, scene by scene. The first result of each scene, "touch", checks that the renderer
// exerts a force in most ticks, or in some ticks if its contact model may lose contact. Without it the other
// checks would mean little. assignments: "r1_m=0.004"; a renderer of a tool has kVerifiedTool unless they
// name another. Throws InputError for an assignment that the renderer refuses, and for a parameter whose
// units cannot be changed (dimension_of()). stop: when set, ends between two scenes with
// Interrupted. Without scenes: verification_scenes(), or tool_scenes() for a renderer of six degrees of
// freedom.
std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::atomic<bool>* stop = nullptr);
std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::vector<MetamorphicScene>& scenes,
                                         const std::atomic<bool>* stop = nullptr);

struct CheckName {
  const char* name;
  const char* meaning;
};
// Returns the checks in the order of the results.
std::vector<CheckName> check_names(DegreesOfFreedom degrees_of_freedom = DegreesOfFreedom::three);

}  // namespace remote_touch
