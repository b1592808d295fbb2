#include "scenarios/simulated/scenario.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace remote_touch {

int Scenario::newest_frame(double time_s) const {
  const int last = frame_count() - 1;
  const double guess = std::max(0.0, time_s) * frame_rate_hz();  // exact for a steady stream
  int frame = static_cast<int>(std::min(guess, static_cast<double>(last)));
  while (frame > 0 && captured_s(frame) > time_s + kSameTime_s) --frame;
  while (frame < last && captured_s(frame + 1) <= time_s + kSameTime_s) ++frame;
  return frame;
}

// The gradient of a distance has length 1, except where the nearest point of the surface jumps: differences
// across such a position are shorter. The limit allows curvature (1 - length is about 7e-5 at a radius of 5
// mm) and finds every crease whose sides meet at more than 5 degrees.
Vec3 Scenario::true_normal(const Vec3& p_W, double time_s) const {
  constexpr double kStep_m = 1e-4, kMaxShortening = 1e-3;
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kStep_m * Vec3::Unit(axis);
    gradient[axis] =
        (signed_distance(p_W + step, time_s) - signed_distance(p_W - step, time_s)) / (2 * kStep_m);
  }
  const double length = gradient.norm();
  if (!(std::abs(length - 1) <= kMaxShortening)) return Vec3::Constant(std::nan(""));
  return gradient / length;
}

// Returns null if the frame is not kept.
KeptFrames::Points KeptFrames::find(std::size_t frame) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find_if(kept_, [&](const Kept& k) { return k.frame == frame; });
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
