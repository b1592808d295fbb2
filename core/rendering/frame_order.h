// Which frame of a stream is the newest. A frame that was not captured later than it is dropped and reported
// once.
#pragma once

#include <utility>

#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

class FrameOrder {
 public:
  // Whether the frame is newer than all before.
  bool is_newer(const Frame& frame) const;
  // The same; it is then the newest.
  bool take(const Frame& frame);
  int newest() const { return index_; }  // -1 before the first
  double captured_s() const { return captured_s_; }

  // The status of a tick, where nothing more serious is to be said: whether a frame was dropped since the
  // last one.
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
