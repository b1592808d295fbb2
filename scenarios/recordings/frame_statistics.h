// Times and statistics of the frames of a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// Times at which the frames of a recording are shown, and their rate. The frames of a part of a recording in
// the order in which they are played. Frame 0 is shown at 0 s. Without a chosen rate, successive frames are
// as far apart in time as in the recording, also if the part is played again. A loop adds one mean period
// from the last frame to the first. Ping-pong plays the stamps forwards and backwards in turn.
class FrameTimes {
 public:
  enum class Playback { hold, loop, ping_pong };

  // chosen_hz: the rate at which all frames are played, regardless of their stamps; 0: as recorded. Throws
  // InputError about the part if the resulting mean rate is above kMaxFrameRate_hz.
  FrameTimes(const RecordingIndex& recording, const InputPart& part, Playback playback, double chosen_hz);

  // The rate at which the frames are played. If the period varies, it is the mean rate of the part.
  double rate_hz() const { return rate_hz_; }
  // Number of frames in the part.
  int count() const { return count_; }
  // Number of the part's first frame within the recording.
  int first() const { return first_; }
  // Returns the number, within the recording, of a frame of the playback. Ping-pong turns round at both ends
  // without repeating the frame there: 0 1 2 3 2 1 0 1 ...
  std::size_t source(int frame) const;
  double captured_s(int frame) const;

  // "30 Hz", "30 Hz with pauses of up to 1 s (5.83 Hz on average)", "30 Hz (recorded at 0.987 Hz)".
  std::string text() const;
  // Returns true if the frames are shown at the times of their stamps.
  bool follows_stamps() const { return is_stamped_ && chosen_hz_ == 0 && count_ > 1; }
  // Returns the rate without the pauses: the inverse of the median time between successive frames. Pre:
  // follows_stamps().
  double usual_rate_hz() const;

 private:
  int index_in_part(int frame) const;

  Playback playback_;
  bool is_stamped_;
  double chosen_hz_, recorded_hz_, rate_hz_;
  int first_ = 0, count_ = 0;
  std::vector<double> since_first_s_;  // one for each frame of the part
};

// Statistics of a recording, counted over the frames that were read. They give a part of the line that a run
// prints about its input, and notes on frames that may not be what the user meant.
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
