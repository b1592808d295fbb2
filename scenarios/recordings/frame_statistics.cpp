#include "scenarios/recordings/frame_statistics.h"

#include <algorithm>
#include <cmath>

#include "core/points/number_columns.h"
#include "core/points/point_cloud.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

// A time between two frames that is longer than 1.5 periods is nearer to two periods than to one: a frame is
// missing.
constexpr double kPausePeriods = 1.5;

std::vector<double> periods_s(const std::vector<double>& times_s) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < times_s.size(); ++i) periods.push_back(times_s[i] - times_s[i - 1]);
  return periods;
}

std::string number(double value) {
  return formatted("%.6g", value);
}

// Two points that are at most a cell apart lie in the same cell or in neighbouring ones. A surface that moves
// by up to 50 mm between two frames (1.5 m/s at 30 Hz) therefore counts as unmoved, regardless of the borders
// of the cells.
constexpr double kCell_m = 0.05;
// Two frames show different places if the share of occupied cells of one frame that are near an occupied cell
// of the other is below this. Successive frames of the recordings in shared/data have a share of 0.85 or
// more, frames of different scenes have 0 to 0.52.
constexpr double kLeastOverlap = 0.5;
constexpr std::size_t kComparedPoints = 20000;
// A note is written if more than this share of the points was dropped: a background is often beyond the
// limit.
constexpr double kDroppedShare = 0.1;

// The number of a cell has 21 bits for each axis. Indices are at most 1e6, so that those of neighbours fit,
// too.
constexpr int kAxisBits = 21;

std::uint64_t cell_of(const Vec3& p) {
  std::uint64_t cell = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = std::clamp(std::floor(p[axis] / kCell_m), -1e6, 1e6);
    cell = (cell << kAxisBits) |
           static_cast<std::uint64_t>(static_cast<std::int64_t>(place) + (1 << (kAxisBits - 1)));
  }
  return cell;
}

// True if the cell or one of its 26 neighbours is among the cells, which are sorted. Three cells in a row
// along the last axis have successive numbers.
bool is_near(std::uint64_t cell, const std::vector<std::uint64_t>& cells) {
  constexpr std::uint64_t kStepX = std::uint64_t{1} << (2 * kAxisBits),
                          kStepY = std::uint64_t{1} << kAxisBits;
  for (const std::uint64_t along_x : {cell, cell - kStepX, cell + kStepX})  // the likeliest first
    for (const std::uint64_t row : {along_x, along_x - kStepY, along_x + kStepY}) {
      const auto found = std::ranges::lower_bound(cells, row - 1);
      if (found != cells.end() && *found <= row + 1) return true;
    }
  return false;
}

std::vector<std::uint64_t> occupied_cells(const PointCloud& cloud, double max_depth_m) {
  std::vector<std::uint64_t> cells;
  const std::size_t step = 1 + cloud.size() / kComparedPoints;
  for (std::size_t i = 0; i < cloud.size(); i += step)
    if (cloud.is_measured(i) && !(cloud.image && cloud.z[i] > max_depth_m))
      cells.push_back(cell_of(cloud.point(i)));
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::string percent(double share) {
  return formatted("%.3g %%", 100 * share);
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Returns the share of the cells that are near one of the others.
double share_near(const std::vector<std::uint64_t>& cells, const std::vector<std::uint64_t>& others) {
  const auto near = std::ranges::count_if(cells, [&](std::uint64_t cell) { return is_near(cell, others); });
  return share(static_cast<std::size_t>(near), cells.size());
}

}  // namespace

FrameTimes::FrameTimes(const RecordingIndex& recording, const InputPart& part, Playback playback,
                       double chosen_hz)
    : playback_(playback),
      is_stamped_(recording.is_stamped),
      chosen_hz_(chosen_hz),
      recorded_hz_(recording.frame_rate_hz) {
  const FrameRange frames = frames_of(part, recording);
  first_ = frames.first, count_ = frames.last - frames.first + 1;
  const double first_s = recording.frames[static_cast<std::size_t>(first_)].captured_s;
  for (int i = first_; i <= frames.last; ++i)
    since_first_s_.push_back(recording.frames[static_cast<std::size_t>(i)].captured_s - first_s);
  if (is_stamped_ && count_ > 1) recorded_hz_ = (count_ - 1) / since_first_s_.back();
  rate_hz_ = chosen_hz > 0 ? chosen_hz : recorded_hz_;
  if (!(rate_hz_ <= kMaxFrameRate_hz))
    refuse(part.path, "frames ", first_, " to ", frames.last, " have timestamps of more than ",
           number(kMaxFrameRate_hz), " frames a second: expected seconds");
}

int FrameTimes::index_in_part(int frame) const {
  switch (playback_) {
    case Playback::hold:
      return std::min(frame, count_ - 1);
    case Playback::loop:
      return frame % count_;
    case Playback::ping_pong:
      break;
  }
  const int cycle = std::max(1, 2 * count_ - 2), index = frame % cycle;
  return index >= count_ ? cycle - index : index;
}

std::size_t FrameTimes::source(int frame) const {
  return static_cast<std::size_t>(first_ + index_in_part(frame));
}

double FrameTimes::captured_s(int frame) const {
  if (chosen_hz_ > 0) return frame / rate_hz_;
  const double since_first_s = since_first_s_[static_cast<std::size_t>(index_in_part(frame))];
  if (playback_ == Playback::hold) return since_first_s;
  if (!follows_stamps()) return frame / rate_hz_;  // a steady rate, without the rounding of sums
  const double length_s = since_first_s_.back();
  const int rounds = frame / count_;
  if (playback_ == Playback::loop) return rounds * (length_s + 1 / rate_hz_) + since_first_s;
  const int turns = frame / (count_ - 1);
  return turns * length_s + (turns % 2 == 0 ? since_first_s : length_s - since_first_s);
}

double FrameTimes::usual_rate_hz() const {
  std::vector<double> periods = periods_s(since_first_s_);
  return 1 / median_in_place(periods);
}

std::string FrameTimes::text() const {
  if (chosen_hz_ > 0) {
    const std::string recorded = number(recorded_hz_), played = number(chosen_hz_);
    return played + " Hz" + (played == recorded ? "" : " (recorded at " + recorded + " Hz)");
  }
  if (!follows_stamps()) return number(rate_hz_) + " Hz";
  const std::vector<double> periods = periods_s(since_first_s_);
  const double longest_s = *std::ranges::max_element(periods), usual_hz = usual_rate_hz();
  if (longest_s * usual_hz <= kPausePeriods) return number(rate_hz_) + " Hz";
  return number(usual_hz) + " Hz with pauses of up to " + number(longest_s) + " s (" + number(rate_hz_) +
         " Hz on average)";
}

void FrameStatistics::add(std::size_t frame, const PointCloud& cloud, double max_depth_m) {
  if (has(frame)) return;
  compare_with_last(frame, cloud, max_depth_m);
  count(frame, cloud, max_depth_m);
  is_read_[frame] = true;
  ++frames_;
}

void FrameStatistics::count(std::size_t frame, const PointCloud& cloud, double max_depth_m) {
  are_images_ |= cloud.image.has_value();
  points_ += cloud.size();
  const std::size_t measured_before = measured_;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    ++measured_;
    if (cloud.image && cloud.z[i] > max_depth_m) ++beyond_limit_;
    lowest_m_ = lowest_m_.cwiseMin(cloud.point(i)), highest_m_ = highest_m_.cwiseMax(cloud.point(i));
  }
  if (measured_ == measured_before) return;  // a frame without points lacks no colours
  if (cloud.colour.empty()) {
    if (colourless_frames_++ == 0 || frame < first_colourless_) first_colourless_ = frame;
    return;
  }
  ++coloured_frames_;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i) && cloud.colour[i] == kNoColour) ++colourless_;
}

void FrameStatistics::compare_with_last(std::size_t frame, const PointCloud& cloud, double max_depth_m) {
  std::vector<std::uint64_t> cells = occupied_cells(cloud, max_depth_m);
  const bool follows = frames_ > 0 && (frame == last_ + 1 || frame + 1 == last_);
  if (follows && !cells.empty() && !cells_.empty()) {
    const double overlap = std::min(share_near(cells, cells_), share_near(cells_, cells));
    const std::size_t later = std::max(frame, last_);
    if (overlap < kLeastOverlap && (apart_++ == 0 || later < first_apart_))
      first_apart_ = later, overlap_of_first_ = overlap;
  }
  cells_ = std::move(cells);
  last_ = frame;
}

std::string FrameStatistics::range() const {
  const Vec3 &low = lowest_m_, &high = highest_m_;
  if (are_images_) return formatted(", depth %.3g to %.3g m", low.z(), high.z());
  return formatted(", x %.3g to %.3g m, y %.3g to %.3g m, z %.3g to %.3g m", low.x(), high.x(), low.y(),
                   high.y(), low.z(), high.z());
}

std::string FrameStatistics::text() const {
  std::string text = std::to_string(frames_) + " read: " + percent(share(measured_, points_)) + " of " +
                     std::to_string(points_) + " points measured";
  if (measured_ > 0) text += range();
  return text + (coloured_frames_ > 0 ? ", with colours" : ", without colours");
}

std::vector<Note> FrameStatistics::notes(double max_depth_m) const {
  std::vector<Note> notes;
  if (const double dropped = share(beyond_limit_, measured_); dropped > kDroppedShare)
    notes.push_back({"points dropped",
                     percent(dropped) + formatted(" of the measured points were dropped: they are beyond "
                                                  "scenario.max_depth_m = %g along the camera's axis",
                                                  max_depth_m)});
  if (colourless_ > 0)
    notes.push_back(
        {"colours missing", percent(share(colourless_, measured_)) +
                                " of the measured points have no colour (NaN): no fixture selects "
                                "them by their hue"});
  if (coloured_frames_ > 0 && colourless_frames_ > 0)
    notes.push_back({"colours missing", std::to_string(colourless_frames_) + " of " +
                                            std::to_string(coloured_frames_ + colourless_frames_) +
                                            " frames have no colours, the first is frame " +
                                            std::to_string(first_colourless_)});
  if (apart_ > 0)
    notes.push_back(
        {"frames apart", std::to_string(apart_) + " pair(s) of successive frames show different " +
                             "places, the first is frames " + std::to_string(first_apart_ - 1) + " and " +
                             std::to_string(first_apart_) + ": only " + percent(overlap_of_first_) +
                             " of the space that a frame shows is near what the other shows"});
  return notes;
}

std::vector<Note> unused_frames(const std::vector<bool>& is_used) {
  const auto unused = std::ranges::count(is_used, false);
  if (unused == 0) return {};
  const auto after = std::find(is_used.rbegin(), is_used.rend(), true) - is_used.rbegin();
  const std::string reason = unused == after ? "the run ended before them"
                             : after == 0    ? "newer frames replaced them, or they were lost"
                                             : "the run ended before " + std::to_string(after) +
                                                " of them; newer frames replaced "
                                                "the others, or they were lost";
  return {{"frames unused", std::to_string(unused) + " of " + std::to_string(is_used.size()) +
                                " frames were not used: " + reason}};
}

}  // namespace remote_touch
