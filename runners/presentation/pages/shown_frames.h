// The frames of a run, made again from its configuration, as a page shows them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_shape/voxel_tool.h"
#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "core/rendering/frame.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

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

}  // namespace remote_touch
