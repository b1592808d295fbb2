// Statistics of the points in a sensor's frames, for the line that reports what a session has read.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "runners/experiment/sessions/sensor_frame.h"

namespace remote_touch {

class SensedPoints {
 public:
  // Adds the points of a frame. Allocates nothing. pre: is_complete(frame, view).
  void add(const SensorFrame& frame, const SensorView& view);

  std::int64_t frames() const { return frames_; }
  // Returns a text such as "68.3 % of 3686400 points measured, depth 0.41 to 2.98 m, with colours". The depth
  // is along the optical axis. Clouds of points have no depth: the text then has the range of their z.
  std::string text() const;

 private:
  void add_image(const SensorFrame& frame, double metres_per_unit);
  void add_cloud(const SensorFrame& frame, std::size_t numbers_per_point);

  std::int64_t frames_ = 0;
  std::uint64_t points_ = 0, measured_ = 0;
  double nearest_m_ = std::numeric_limits<double>::infinity();
  double farthest_m_ = -std::numeric_limits<double>::infinity();
  bool are_clouds_ = false, has_colours_ = false;
};

// Returns a text such as "640 x 480 pixels", or "clouds of points".
std::string layout_text(const SensorView& view);

}  // namespace remote_touch
