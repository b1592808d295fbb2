#include "scenarios/interface/kept_frames.h"

#include <algorithm>
#include <utility>

namespace remote_touch {

// Returns null if the frame is not kept.
KeptFrames::Points KeptFrames::find(std::size_t frame) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.frame == frame; });
  if (found == kept_.end()) return nullptr;
  std::rotate(kept_.begin(), found, found + 1);
  return kept_.front().points;
}

KeptFrames::Points KeptFrames::get(std::size_t frame, const std::function<Points()>& make) {
  if (Points points = find(frame)) return points;
  Points made = make();  // the lock is free, so that other frames are made meanwhile
  if (Points points = find(frame)) return points;
  const std::lock_guard lock(mutex_);
  if (kept_.size() == at_most_) kept_.pop_back();
  kept_.insert(kept_.begin(), {frame, made});
  return made;
}

}  // namespace remote_touch
