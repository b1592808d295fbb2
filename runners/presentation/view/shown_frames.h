// The frames of a run, made again from its configuration, as a page shows them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/presentation/view/shown_points.h"
#include "runners/presentation/view/touching_points.h"

namespace remote_touch {

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
