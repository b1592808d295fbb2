#include "runners/live/loop/live_contact.h"

#include <algorithm>

namespace remote_touch {

LiveContact::LiveContact(const Experiment& experiment)
    : ball_radius_m_(experiment.build_fixtures().empty() ? experiment.rendered_contact().ball_radius_m : 0),
      is_over_(!(ball_radius_m_ > 0)) {}

void LiveContact::add(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  if (is_over_) return;
  frames_[next_] = {frame.index, frame.points};
  next_ = (next_ + 1) % kKeptFrames;
}

void LiveContact::add(const LiveTick& tick, double time_s) {
  ContactWatch::Points points;
  {
    const std::lock_guard lock(mutex_);
    if (is_over_) return;
    const auto found = std::find_if(frames_.begin(), frames_.end(), [&](const KeptFrame& kept) {
      return kept.points && kept.index == tick.out.frame_index;
    });
    if (found == frames_.end()) return;
    points = found->points;
  }
  watch_.add(time_s, tick.device.position_W, tick.out, points);
  if (!watch_.has_contact()) return;
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  frames_ = {};
}

std::vector<Note> LiveContact::notes(const Kernels& kernels) const {
  return ball_radius_m_ > 0 ? watch_.spacing_notes(ball_radius_m_, kernels) : std::vector<Note>();
}

}  // namespace remote_touch
