// Statistics of a recording, counted over the frames that were read. They give a part of the line that a run
// prints about its input, and notes on frames that may not be what the user meant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

class FrameStatistics {
 public:
  explicit FrameStatistics(std::size_t frame_count) : is_read_(frame_count, false) {}

  bool has(std::size_t frame) const { return is_read_[frame]; }
  // cloud: the frame as it was measured, before the limit is applied: an image in its camera's frame, any
  // other cloud in its own coordinates, to which the limit does not apply. All frames are images, or none is.
  // A frame that was added before is ignored.
  void add(std::size_t frame, const PointCloud& cloud, double max_depth_m);

  std::size_t frames_read() const { return frames_; }
  // "12 read: 68.3 % of 307200 points measured, depth 0.41 to 2.98 m, with colours". Clouds without a camera
  // have no depth; the text then has the range of each coordinate.
  std::string text() const;
  // Points that were dropped, points and frames without colour, and frames that do not overlap with the frame
  // before them.
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
  // Frames with measured points: those with colours, those without, and the first of the latter.
  std::size_t coloured_frames_ = 0, colourless_frames_ = 0, first_colourless_ = 0;
  std::size_t last_ = 0;              // the frame that was read last, if there is one
  std::vector<std::uint64_t> cells_;  // cells that its points occupy, sorted
  // Pairs of successive frames without overlap: how many, the later frame of the first, and their overlap.
  std::size_t apart_ = 0, first_apart_ = 0;
  double least_overlap_ = 1;
};

// The note "frames unused", if a frame was not used, with the reason. is_used: of each frame, in the order of
// arrival.
std::vector<Note> unused_frames(const std::vector<bool>& is_used);

}  // namespace remote_touch
