// Detects whether a tool still approaches its device within a tick. Steps that move back and forth forever
// count as rest, however long they are.
#pragma once

#include <algorithm>
#include <limits>

namespace remote_touch {

class MotionProgress {
 public:
  // min_m: an approach by this or less is no progress. patience: number of successive updates without
  // progress after which the progress has ended.
  MotionProgress(double min_m, int patience) : min_m_(min_m), patience_(patience) {}

  // remaining_m: remaining displacement to the device, as max_point_displacement_m() measures it.
  void update(double remaining_m) {
    without_ = remaining_m < nearest_distance_m_ - min_m_ ? 0 : without_ + 1;
    nearest_distance_m_ = std::min(nearest_distance_m_, remaining_m);
  }
  bool has_ended() const { return without_ >= patience_; }

 private:
  const double min_m_;
  const int patience_;
  double nearest_distance_m_ = std::numeric_limits<double>::infinity();
  int without_ = 0;  // updates since the last progress
};

}  // namespace remote_touch
