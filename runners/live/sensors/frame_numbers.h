// Numbers of frames from what a camera tells: its own count, which may begin anew, or its stamps.
#pragma once

#include <cmath>

namespace remote_touch {

class FrameNumbers {
 public:
  // The number of a frame that comes so many after the one before. What is no such number, as when the camera
  // was reset, counts as one.
  int next(double steps) {
    number_ += steps >= 1 && steps <= kMaxGap ? static_cast<int>(std::lround(steps)) : 1;
    return number_;
  }

 private:
  static constexpr double kMaxGap = 10000;

  int number_ = 0;
};

}  // namespace remote_touch
