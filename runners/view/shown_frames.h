// The frames of a run, made again from its configuration, as a page shows them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/experiment/experiment.h"
#include "runners/view/shown_points.h"
#include "runners/view/touching_points.h"

namespace remote_touch {

// What of a run decides how its frames are shown; a row for each tick.
struct RunPath {
  std::vector<double> time_s;
  std::vector<Vec3> proxy_W;
  std::vector<std::int32_t> frame;        // newest frame in use
  double touch_radius_m = 0;              // of a proxy: r2
  std::shared_ptr<const VoxelTool> tool;  // null: a proxy
  std::vector<Eigen::Quaterniond> tool_orientation_W;
  std::vector<std::uint64_t> frame_hash;  // of the newest frame; 0: not computed
};

// A position is low + step * number, three numbers for a point.
struct PointScale {
  Vec3 low_W = Vec3::Zero();
  double step_m = 0;
};
PointScale point_scale(const BoundingBox& box_W);

struct ShownFrame {
  int index = 0;
  double captured_s = 0;
  std::size_t measured = 0, in_box = 0, others = 0;  // as of ShownPoints
  std::vector<std::uint32_t> rank;
  std::vector<std::uint16_t> positions;
  std::vector<std::uint8_t> colours;    // red, green and blue of each point; empty: no colour
  std::vector<float> fixture_radius_m;  // of each point; empty: no fixture
  // The points that touch the tool, as places in the list of shown points, tick after tick from the first
  // that used the frame on; touching_end: where those of a tick end. Empty without a tool.
  std::vector<std::uint32_t> touching, touching_end;
};

// With about so many others, no more than it has.
ShownFrame thinned(const ShownFrame& frame, std::size_t max_others);

struct ShownFrames {
  std::vector<ShownFrame> frames;
  std::optional<RigidTransform> X_WC;  // of the camera that took the first; none: no image
  bool are_those_of_the_run = true;    // as far as frame_hash tells
};

// Every frame that a tick used, in order. Throws InputError as the run itself would, and Interrupted.
ShownFrames shown_frames(const Experiment& experiment, const RunPath& path, const ShownPointsRule& rule,
                         const Kernels& kernels, const std::atomic<bool>* stop);

}  // namespace remote_touch
