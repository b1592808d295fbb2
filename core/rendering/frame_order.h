// Which frame of a stream is the newest. A frame captured no later than that is dropped, and reported once.
#pragma once

#include <utility>

#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

class FrameOrder {
 public:
  // Whether the frame is newer than all before.
  bool is_newer(const Frame& frame) const;
  // The same; if so, it becomes the newest.
  bool take(const Frame& frame);
  int newest() const { return index_; }  // -1 before the first
  double captured_s() const { return captured_s_; }

  // The status of a tick: `otherwise`, or stale_frame_dropped if that is ok and a frame was dropped since the
  // last tick.
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
