#include "scenarios/recordings/frame_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "core/cloud/colour.h"

namespace remote_touch {

namespace {

// A camera that is moved by hand keeps most of its view from frame to frame, another scene shares little.
constexpr double kLeastOverlap = 0.3;
constexpr double kCell_m = 0.05;
constexpr std::size_t kComparedPoints = 20000;
// A note is written if more points than this were dropped: a background is often beyond the limit.
constexpr double kDroppedShare = 0.1;

std::uint64_t cell_of(const Vec3& p) {
  std::uint64_t cell = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = std::clamp(std::floor(p[axis] / kCell_m), -1e6, 1e6);
    cell = (cell << 21) | static_cast<std::uint64_t>(static_cast<std::int64_t>(place) + (1 << 20));
  }
  return cell;
}

std::vector<std::uint64_t> occupied_cells(const PointCloud& cloud, double max_depth_m) {
  std::vector<std::uint64_t> cells;
  const std::size_t step = 1 + cloud.size() / kComparedPoints;
  for (std::size_t i = 0; i < cloud.size(); i += step)
    if (cloud.is_measured(i) && cloud.z[i] <= max_depth_m) cells.push_back(cell_of(cloud.point(i)));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void FrameStatistics::add(std::size_t frame, const PointCloud& cloud, double max_depth_m) {
  if (has(frame)) return;
  compare_with_last(frame, cloud, max_depth_m);
  count(cloud, max_depth_m);
  is_read_[frame] = true;
  ++frames_;
}

void FrameStatistics::count(const PointCloud& cloud, double max_depth_m) {
  points_ += cloud.size();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    ++measured_;
    if (cloud.z[i] > max_depth_m) ++beyond_limit_;
    nearest_m_ = std::min(nearest_m_, cloud.z[i]), farthest_m_ = std::max(farthest_m_, cloud.z[i]);
  }
  if (cloud.colour.empty()) return;
  has_colours_ = true;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i) && cloud.colour[i] == kNoColour) ++colourless_;
}

void FrameStatistics::compare_with_last(std::size_t frame, const PointCloud& cloud, double max_depth_m) {
  std::vector<std::uint64_t> cells = occupied_cells(cloud, max_depth_m);
  const bool follows = frames_ > 0 && (frame == last_ + 1 || frame + 1 == last_);
  if (follows && !cells.empty() && !cells_.empty()) {
    std::vector<std::uint64_t> common;
    std::set_intersection(cells.begin(), cells.end(), cells_.begin(), cells_.end(),
                          std::back_inserter(common));
    const double overlap = share(common.size(), std::min(cells.size(), cells_.size()));
    if (overlap < kLeastOverlap && apart_++ == 0) first_apart_ = std::max(frame, last_);
    least_overlap_ = std::min(least_overlap_, overlap);
  }
  cells_ = std::move(cells);
  last_ = frame;
}

std::string FrameStatistics::text() const {
  std::string text = std::to_string(frames_) + " read: " + percent(share(measured_, points_)) + " of " +
                     std::to_string(points_) + " points measured";
  if (measured_ > 0) {
    char depth[80];
    std::snprintf(depth, sizeof depth, ", depth %.3g to %.3g m", nearest_m_, farthest_m_);
    text += depth;
  }
  return text + (has_colours_ ? ", with colours" : ", without colours");
}

std::vector<Note> FrameStatistics::notes(double max_depth_m) const {
  std::vector<Note> notes;
  if (const double dropped = share(beyond_limit_, measured_); dropped > kDroppedShare) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g", max_depth_m);
    notes.push_back({"points dropped", percent(dropped) +
                                           " of the measured points were dropped: they are beyond "
                                           "scenario.max_depth_m = " +
                                           limit});
  }
  if (colourless_ > 0)
    notes.push_back({"colours missing", percent(share(colourless_, measured_)) +
                                            " of the measured points have no colour (NaN): no fixture takes "
                                            "them by their hue"});
  if (apart_ > 0)
    notes.push_back({"frames apart", std::to_string(apart_) +
                                         " pair(s) of successive frames show different " +
                                         "places, the first is frames " + std::to_string(first_apart_ - 1) +
                                         " and " + std::to_string(first_apart_) + ": only " +
                                         percent(least_overlap_) + " of the space is common to a pair"});
  return notes;
}

}  // namespace remote_touch
