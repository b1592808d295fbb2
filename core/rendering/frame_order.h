// The newest frame of a stream. A frame that was captured no later than the newest one is dropped, and the
// drop is reported once.
#pragma once

#include <utility>

#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

class FrameOrder {
 public:
  // Returns true if the frame was captured after the newest one, or is the first.
  bool is_newer(const Frame& frame) const;
  // Same as is_newer(). A newer frame becomes the newest one; any other frame counts as dropped.
  bool accept_if_newer(const Frame& frame);
  int newest() const { return index_; }  // index of the newest frame; -1 before the first
  double captured_s() const { return captured_s_; }

  // Returns the status of a tick: stale_frame_dropped if `otherwise` is ok and a frame was dropped since the
  // last tick, else `otherwise`.
  RenderStatus status(RenderStatus otherwise) {
    const bool dropped = std::exchange(dropped_, false);
    return dropped && otherwise == RenderStatus::ok ? RenderStatus::stale_frame_dropped : otherwise;
  }

 private:
  int index_ = -1;
  double captured_s_ = 0;
  bool dropped_ = false;
};

}  // namespace remote_touch
