// Whether a tool still comes nearer to its device within a tick. An oscillation counts as rest too, however
// long its steps are.
#pragma once

#include <algorithm>
#include <limits>

namespace remote_touch {

class Progress {
 public:
  // min_m: coming nearer by this or less is none. patience: how many looks without progress end it.
  Progress(double min_m, int patience) : min_m_(min_m), patience_(patience) {}

  // The way left to the device, way_m(), at one more look.
  void update(double remaining_m) {
    without_ = remaining_m < nearest_distance_m_ - min_m_ ? 0 : without_ + 1;
    nearest_distance_m_ = std::min(nearest_distance_m_, remaining_m);
  }
  bool has_ended() const { return without_ >= patience_; }

 private:
  const double min_m_;
  const int patience_;
  double nearest_distance_m_ = std::numeric_limits<double>::infinity();
  int without_ = 0;  // looks since the last progress
};

}  // namespace remote_touch
