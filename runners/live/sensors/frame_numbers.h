// Numbers frames by the camera's own count, which may restart, or by its time stamps.
#pragma once

#include <cmath>

namespace remote_touch {

class FrameNumbers {
 public:
  // Returns the number of a frame that is `steps` after the one before. Steps that are not between 1 and
  // kMaxGap, for instance after a reset of the camera, count as one.
  int next(double steps) {
    number_ += steps >= 1 && steps <= kMaxGap ? static_cast<int>(std::lround(steps)) : 1;
    return number_;
  }

 private:
  static constexpr double kMaxGap = 10000;

  int number_ = 0;
};

}  // namespace remote_touch
