// Whether a tool still comes nearer to its device within a tick: steps that lead to and fro for ever are rest
// too, however long they are.
#pragma once

#include <algorithm>
#include <limits>

namespace remote_touch {

class Progress {
 public:
  // least_m: coming nearer by this or less is none. patience: how many looks without progress end it.
  Progress(double least_m, int patience) : least_m_(least_m), patience_(patience) {}

  // The way left to the device, way_m(), at one more look.
  void look(double left_m) {
    without_ = left_m < nearest_m_ - least_m_ ? 0 : without_ + 1;
    nearest_m_ = std::min(nearest_m_, left_m);
  }
  bool has_ended() const { return without_ >= patience_; }

 private:
  const double least_m_;
  const int patience_;
  double nearest_m_ = std::numeric_limits<double>::infinity();
  int without_ = 0;  // looks since the last progress
};

}  // namespace remote_touch
