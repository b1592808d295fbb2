// Statistics of a recording, counted over the frames that were read. They give a part of the line that a run
// prints about its input, and notes on frames that may not be what the user meant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class FrameStatistics {
 public:
  explicit FrameStatistics(std::size_t frame_count) : is_read_(frame_count, false) {}

  bool has(std::size_t frame) const { return is_read_[frame]; }
  // Counts a frame. cloud: the frame as it was measured, before the limit is applied. An image is in its
  // camera's frame. Any other cloud is in its own coordinates, and the limit does not apply to it. Either all
  // frames are images or none is. A frame that was added before is ignored.
  void add(std::size_t frame, const PointCloud& cloud, double max_depth_m);

  std::size_t frames_read() const { return frames_; }
  bool has_points() const { return measured_ > 0; }
  // Returns "12 read: 68.3 % of 307200 points measured, depth 0.41 to 2.98 m, with colours". Clouds without a
  // camera have no depth; the text then has the range of each coordinate.
  std::string text() const;
  // Returns notes about points that were dropped, about points and frames without colour, and about frames
  // that do not overlap with the frame before them.
  std::vector<Note> notes(double max_depth_m) const;

 private:
  void count(std::size_t frame, const PointCloud& cloud, double max_depth_m);
  std::string range() const;
  void compare_with_last(std::size_t frame, const PointCloud& cloud, double max_depth_m);

  std::vector<bool> is_read_;
  std::size_t frames_ = 0, points_ = 0, measured_ = 0, beyond_limit_ = 0, colourless_ = 0;
  // Bounding box of all measured points. In images its z is the depth.
  Vec3 lowest_m_ = Vec3::Constant(std::numeric_limits<double>::infinity()), highest_m_ = -lowest_m_;
  bool are_images_ = false;
  // Among the frames with measured points: the number with colours, the number without, and the lowest frame
  // without.
  std::size_t coloured_frames_ = 0, colourless_frames_ = 0, first_colourless_ = 0;
  std::size_t last_ = 0;              // the frame that was read last, if there is one
  std::vector<std::uint64_t> cells_;  // cells that its points occupy, sorted
  // Pairs of successive frames with too little overlap: their number, and the later frame and the overlap of
  // the pair that is first in the recording.
  std::size_t apart_ = 0, first_apart_ = 0;
  double overlap_of_first_ = 1;
};

// Returns the note "frames unused", with the reason, if a frame was not used. is_used has one element for
// each frame, in the order of arrival.
std::vector<Note> unused_frames(const std::vector<bool>& is_used);

}  // namespace remote_touch
