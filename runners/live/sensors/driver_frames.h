// Frames as drivers deliver them: their numbers, their times and their rows of pixels.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/points/point_cloud.h"

namespace remote_touch {

// Numbers frames by the camera's own count, which may restart, or by its time stamps.
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

// Conversion of times from the clock of a sensor to that of the host. Arrivals jitter by milliseconds with
// the bus and the scheduler; the sensor's stamps are regular, but have their own origin. The difference
// arrival - stamp is the wanted offset plus a delay that is never negative, so the smallest difference is
// nearest to the offset. It still contains the delay common to all frames: exposure and transfer cannot be
// measured on the host.
class SensorClock {
 public:
  // Returns the time at which the frame with this stamp was captured, on the clock of the arrival: later than
  // the frame before, and not later than the arrival. pre: called in the order of arrival.
  double captured_s(double stamp_s, double arrived_s);

 private:
  bool has_begun_ = false;
  double offset_s_ = 0;
  double stamp_s_ = 0;     // time stamp of the frame before
  double captured_s_ = 0;  // time of capture of the frame before
};

// Images as drivers deliver them: rows of pixels with gaps between them, sometimes mirrored.
struct PixelRows {
  const void* first = nullptr;
  std::size_t bytes = 0;  // number of bytes that may be read
  int width = 0, height = 0;
  std::size_t stride = 0;  // bytes from row to row
  bool is_mirrored = false;
};

// copy_depth() and copy_rgb() undo the mirroring. They return false, and read nothing, if the image has
// another size than the camera's, or fewer bytes than it needs.
bool copy_depth(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint16_t>& depth);
// Each pixel has three bytes: red, green, blue.
bool copy_rgb(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint32_t>& colour);

}  // namespace remote_touch
