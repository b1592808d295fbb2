// Pages that show results, one or two traces, or a sweep; and the data of one run that they show, as JSON
// that names arrays of numbers.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_result.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/kernels/kernels.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/experiment/catalog/experiment.h"
#include "scenarios/files/input_files.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The frames of a run, made again from its configuration, as a page shows them.

// Returns whether the trace is of a live run, in which a person moved, and not made again from its recording.
bool is_of_live_run(const TextAttributes& trace);

// Returns the experiment of a stored trace. Throws InputError, about the name, in three cases: the trace is
// of a live run, whose frames came from a sensor at times that only its recording contains; the configuration
// cannot be run; or a recording is not the one that was read.
Experiment experiment_of_run(const TextAttributes& trace, const std::string& name);

// Passes to on_frame the frames that had arrived at one of the times, in order of arrival, as the renderer
// received them. If the experiment has a task, the whole run is simulated again instead, and time_s is not
// used. Throws InputError as the run itself would, and Interrupted.
void replay_frames(const Experiment& experiment, std::span<const double> time_s, const Kernels& kernels,
                   const std::atomic<bool>* stop, const std::function<void(const Frame&)>& on_frame);

// Selects the points of a frame that a page shows: all that touch, all near the proxy, and some of the others
// around the action.
struct ShownPointsRule {
  BoundingBox box_W;              // points outside are left out
  double near_m = 0;              // all points in the box this near to a position of the proxy are shown
  std::size_t wanted_others = 0;  // about so many other points in the box are shown, or all if fewer
};

struct ShownPoints {
  std::vector<std::uint32_t> indices;  // indices of the points in the cloud, ascending
  // Rank of each point: 0 for points that touch and points near the proxy. Among the other points, those with
  // the largest ranks are left out first.
  std::vector<std::uint32_t> rank;
  std::size_t measured = 0, in_box = 0, others = 0;  // counts before any point is left out
};

// Returns the rank below which the other points are shown.
std::uint32_t rank_limit(std::size_t others, std::size_t wanted_others);

// always: indices, ascending, of points that are shown wherever they are. The other points are thinned by
// their indices, so that a page shows the same pixels of an image in every frame.
ShownPoints shown_points(const PointCloud& cloud, std::span<const std::uint32_t> always,
                         std::span<const Vec3> proxies_W, const ShownPointsRule& rule);

// Indices of the points that touch the proxy or the tool, ascending, for each tick. Empty for a tick whose
// position is not finite.
using TouchingPoints = std::vector<std::vector<std::uint32_t>>;

// Returns the points whose regions are within radius_m of the proxy's centre. With r2 these are the points
// that contact_count counts, (4.1), (5.2).
TouchingPoints touching_proxy(std::span<const Vec3> centres_W, double radius_m, const PointCloud& cloud);

inline constexpr double kTouchingTool_m = 1e-4;  // points up to this distance from the tool, or in it, touch
TouchingPoints touching_tool(const VoxelTool& tool, std::span<const ToolPose> poses, const PointCloud& cloud);

// The parts of a run that determine how its frames are shown. Each vector has a row for each tick.
struct RunPath {
  std::vector<double> time_s;
  std::vector<Vec3> proxy_W;
  std::vector<std::int32_t> frame;        // newest frame in use
  double touch_radius_m = 0;              // r2 of a proxy
  std::shared_ptr<const VoxelTool> tool;  // null: a proxy
  std::vector<Eigen::Quaterniond> tool_orientation_W;
  std::vector<std::uint64_t> frame_hash;  // hash of the newest frame; 0: not computed
};

// Scale of stored positions: low + step * number, with three numbers for each point.
struct PointScale {
  Vec3 low_W = Vec3::Zero();
  double step_m = 0;
};
PointScale point_scale(const BoundingBox& box_W);

struct ShownFrame {
  int index = 0;
  double captured_s = 0;
  std::size_t measured = 0, in_box = 0, others = 0;  // counts as in ShownPoints
  std::vector<std::uint32_t> rank;
  std::vector<std::uint16_t> positions;
  std::vector<std::uint8_t> colours;    // red, green and blue of each point; empty: no colour
  bool lacks_colours = false;           // points of unknown colour are grey
  std::vector<float> fixture_radius_m;  // r_f of each point; empty: no fixture
  // The points that touch the proxy or tool, as indices in the list of shown points, tick after tick from the
  // first tick that used the frame. touching_end: for each tick, the index behind the last of its points.
  std::vector<std::uint32_t> touching, touching_end;
};

// Returns the frame with about wanted_others of its other points, or with all of them if it has fewer.
ShownFrame thinned(const ShownFrame& frame, std::size_t wanted_others);

struct ShownFrames {
  std::vector<ShownFrame> frames;
  std::optional<RigidTransform> X_WC;  // pose of the camera that took the first frame; none: no image
  bool are_those_of_the_run = true;    // false if a frame differs from its frame_hash
};

// Returns every frame that a tick used, in order. Throws InputError as the run itself would, and Interrupted.
ShownFrames shown_frames(const Experiment& experiment, const RunPath& path, const ShownPointsRule& rule,
                         const Kernels& kernels, const std::atomic<bool>* stop);

// Meshes, tools and cameras as a page shows them, in packed arrays of numbers.

// Arrays of numbers one after another, for a page to read: little endian, each at a multiple of eight bytes.
class PackedArrays {
 public:
  // Returns the position (its first byte), the type (f64, f32, i32, u32, u16 or u8) and the length of the
  // array in bytes(): {"at", "type", "length"}.
  template <class Number>
  Json add(const std::vector<Number>& values);
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

Json json_of(const Vec3& v);
// Returns the position, the viewing direction and the upward direction of the image, in the world frame.
Json sensor_json(const RigidTransform& X_WC);

// The tool of a run, as a page shows it.
struct ShownTool {
  std::shared_ptr<const VoxelTool> tool;
  std::shared_ptr<const ToolSpheres> spheres;  // null: its renderer has none
};

// renderer: the section of a resolved configuration, of a renderer with a tool. Throws as load_tool().
ShownTool shown_tool(const Json& renderer);

// Vertices and triangles of the mesh; of spheres, four numbers each: centre and radius.
Json json_of(const ShownTool& tool, PackedArrays& numbers);

// The true surface of a scene of meshes, as a page shows it: each mesh once, and its poses over time.

// A mesh whose vertices are nodes of a grid in the frame O of the object: low + step * number.
struct MeshOnGrid {
  Vec3 low_O = Vec3::Zero();
  double step_m = 0;
  std::vector<std::uint16_t> vertices;  // three numbers for each vertex
  std::vector<std::uint32_t> triangles;
};

// Moves every vertex to the nearest node of a grid, and merges those of one node. The grid is the finest one
// with 65536 nodes along the longest side of the mesh, or with half of that again and again until at most
// max_triangles have three different corners; the others are left out.
MeshOnGrid mesh_on_grid(const PosedMesh& mesh, std::size_t max_triangles);

// The pose of a mesh from one time to the next: position, then the orientation w, x, y, z, in the world
// frame. All are NaN if it is not known.
using ShownPose = std::array<float, 7>;

struct ShownMesh {
  std::string name;
  MeshOnGrid mesh;
  std::vector<double> time_s;  // one for each pose; the first is the first tick
  std::vector<ShownPose> poses;
};

inline constexpr std::size_t kMaxShownTriangles = 200'000;  // limit for all meshes together
inline constexpr std::size_t kMaxShownPoses = 20'000;       // limit for all meshes together

// time_s: the times of the ticks, at least one. A mesh has a pose for each tick at which its pose changes, so
// that the page shows the surface of signed_distance(). If that makes too many, the meshes with the most
// poses keep every nth. Returns nothing if the true surface is not one of meshes.
std::vector<ShownMesh> shown_meshes(const Scenario& scenario, std::span<const double> time_s);

// The same for a live run, whose end is not known: from time 0 to the end of the scene's motion, at ticks of
// this rate or at 2000 times. The last pose holds from then on. Returns nothing for a recording, whose poses
// may be repeated without an end, and which would have to be read as a whole.
std::vector<ShownMesh> shown_meshes_of_live(const Scenario& scenario, double haptic_rate_hz);

Json json_of(const ShownMesh& mesh, PackedArrays& numbers);
// A remark on the meshes that are drawn more coarsely than by 0.2 mm; empty: none is.
std::string note_on(const std::vector<ShownMesh>& meshes);

// The true surface around the action, where the scene is a height field: its height over a grid at some
// times. It is the surface from which the column signed_distance measures.
struct TrueHeights {
  static constexpr int kColumns = 41;  // along x and along z
  // true: the truth is the surface at the last capture, which stays until the next of these times. false: the
  // surface moves evenly from one of these times to the next.
  bool stays = false;
  std::vector<double> time_s;   // one, where the surface does not move
  std::vector<float> height_m;  // y; x runs fastest, then z, then time; NaN: not known
  // The largest difference between the drawn sheet and the surface that was found: half-way between the times
  // (if the surface moves evenly between them), and half-way between the nodes at three of the times. m.
  // It is no bound: elsewhere the sheet may be off by more.
  double error_m = 0;
  bool empty() const { return height_m.empty(); }
};

// time_s: the times of the ticks, at least one. Returns an empty result if the height is known nowhere. A
// surface that moves evenly has at most 200 times, and up to 600 if the sheet would be off by more than 0.2
// mm half-way between them. One that stays has all times at which it changes, but at most 2000.
TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s);

// A trace, stored or in memory, and what is known of it.
struct RunSource {
  std::string name;  // name on the page and in errors: a file, or a run of a sweep
  std::shared_ptr<const ColumnSource> columns;
  TextAttributes attributes;  // config must be one of them
  std::string note = {};      // remark for the reader of the page
  std::string claims = "[]";  // JSON, see shown_claims()
};

// A run as a page shows it.
class ShownRun {
 public:
  // Throws InputError, about the name, when the configuration cannot be run, or its recording is missing or
  // is not the one that was read.
  ShownRun(RunSource source, const Kernels& kernels, const std::atomic<bool>* stop);
  ~ShownRun();

  const RunSource& source() const;
  std::string title() const;
  std::size_t frame_count() const;  // number of frames in use, at least 1

  // The part of the scene that is shown. Initially it is the region of the action: the positions of HIP and
  // proxy or tool, and slave, and some room around them. The first json() fixes it.
  const BoundingBox& box_W() const;
  void set_box(const BoundingBox& box_W);

  // Adds the first tick with any difference from another run to the events. Throws InputError if the runs
  // have different tick rates, because the page pairs their ticks.
  void mark_divergence_from(const ShownRun& other);

  // The first call makes the frames of the run again; later calls leave out points. wanted_others: see
  // ShownPointsRule; for each frame, and no more than in the first call.
  Json json(PackedArrays& numbers, std::size_t wanted_others);
  // A line about the points that the last json() contained.
  const std::string& shown() const;
  // Remark for the reader, valid after json(); empty: none.
  const std::string& note() const;

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

// A page of the viewer: one self-contained HTML file below a size limit, which reads nothing else.

// The viewer's script and style, runners/presentation/page, which the build embedded in the program.
std::string_view viewer_script();
std::string_view viewer_style();

// Returns an HTML page of the viewer: its script and style, what to show as JSON, and numbers, compressed.
// json: names the arrays in bytes as PackedArrays::add() does. A stored page may not reach the network; the
// server of a live page says what that may reach.
std::string page_file(const std::string& title, const std::string& json, const std::string& bytes,
                      bool is_stored = true);

// Returns the bytes as a page stores them: gzip, then Base64.
std::string gzip_base64(const std::string& bytes);

struct ViewOptions {
  std::size_t max_bytes = 20'000'000;       // size of the page; points are left out until it fits
  std::filesystem::path claims = {};        // a claims.json, for shown_claims(); empty: none
  const Kernels* kernels = nullptr;         // pre: set
  const std::atomic<bool>* stop = nullptr;  // when set, ends with Interrupted
};

struct ViewPage {
  std::string html;
  std::string shown;  // number of shown points in words, a line for each run
};

// Shows the runs and the entries of `page`. numbers: arrays that `page` already names. Throws InputError,
// about the first run, if the page would be too large without any points.
ViewPage view_page(const std::string& title, const std::vector<std::unique_ptr<ShownRun>>& runs,
                   const Json& page, const PackedArrays& numbers, const ViewOptions& options);

// An event of a run that is worth looking at.
struct TraceEvent {
  std::size_t tick;
  const char* kind;  // one of the kinds below, or "divergence", see ShownRun
  std::string text;  // sentence for the reader
};

// Returns the events in the order of their ticks:
//   pop-through    the proxy's centre passes through the true surface to its back, see contact_measures.h
//   first contact  the first tick with a contact
//   slave contact  the first tick with a force of the scene on the slave
//   hardest hit    the first tick with the largest force of the scene on the slave
//   force jump     the largest change of the force from one tick to the next
//   largest force  the first tick with the largest force
//   not converged  the first tick of each spell in which a tick ended before the proxy or tool had converged,
//                  at most 50, then one event that says how many more there are
//   task           a step of the task began or ended
// steps: what the steps of the task do, for the text; may be fewer than there are. held_depth_m: see
// frames_and_outputs.h.
std::vector<TraceEvent> trace_events(const ColumnSource& trace, const std::vector<std::string>& steps = {},
                                     double held_depth_m = 0);

// A page that shows one or two stored traces: the scene, the hand, the proxy or tool and the force in 3-D,
// and the columns as plots.

// Returns the claims of the figure whose experiment was run, which a page shows beside the run: `run fig4.12`
// belongs to figure 4.12. claims: the claims.json of `remote-touch figure`; empty: none. The result is a list
// of objects with claim, paper, measured, unit, criterion and verdict. It is empty for a run of another
// experiment, or with other settings. Throws InputError if the file is not a list of claims.
Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run);

// traces: one, or two to compare. Frames are made again from the stored configurations. Throws InputError,
// naming the file, for a file that is no trace or of a live run, and as ShownRun and view_page() do.
ViewPage trace_page(const std::vector<std::filesystem::path>& traces, const ViewOptions& options);

// A page that shows a sweep: its map, and some of its runs, which are run again.

// Returns the runs of a sweep that a page shows if no cells are named: at most `max` runs whose measure is
// above the threshold, evenly spread over the grid, in ascending order. They are the failures nearest to the
// limit: the first failed run of each cell in which most runs failed and that has a neighbour in which most
// did not. A neighbour is the next cell along an axis that has finished runs. If no cell has such a
// neighbour, any cells with a failed run are used. If no run failed, returns the runs with the smallest and
// the largest value. Empty only if no run is done.
std::vector<std::size_t> default_runs(const SweepResult& result, const std::vector<double>& measure,
                                      double threshold, std::size_t max);

inline constexpr std::size_t kRunsOfSweepPage = 6;  // maximum if no cells are named

// cells: texts that cell_of() reads. The page shows the first failed run of each, or its first finished run
// if none failed. Empty: see default_runs(), with the measure that the sweep refines, else popped_through,
// else its first measure. Throws InputError if the file is not a finished sweep, if the sweep does not have a
// cell or has not run it, and as ShownRun and view_page() do.
ViewPage sweep_page(const std::filesystem::path& file, const std::vector<std::string>& cells,
                    const ViewOptions& options);

}  // namespace remote_touch
