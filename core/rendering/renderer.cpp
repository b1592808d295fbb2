#include "core/rendering/renderer.h"

namespace remote_touch {

bool FrameOrder::is_newer(const Frame& frame) const {
  return index_ < 0 || frame.captured_s > captured_s_;
}

bool FrameOrder::accept_if_newer(const Frame& frame) {
  if (!is_newer(frame)) {
    dropped_ = true;
    return false;
  }
  index_ = frame.index, captured_s_ = frame.captured_s;
  return true;
}

}  // namespace remote_touch
