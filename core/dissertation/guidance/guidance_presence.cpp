#include "core/dissertation/guidance/guidance_presence.h"

#include <algorithm>
#include <utility>

namespace remote_touch {

void GuidancePresence::on_frame(const GuidanceTarget& target, double arrives_s) {
  const bool is_off = target.strength == 0;
  const bool was_seen = std::exchange(is_seen_, !is_off && target.points >= min_points_);
  if (is_off)
    seen_ = {};
  else if (is_seen_)
    seen_ = target;
  else if (was_seen)
    lost_s_ = arrives_s;
}

const GuidanceTarget* GuidancePresence::target(double time_s) const {
  if (is_seen_) return &seen_;
  const bool is_held = hold_s_ > 0 && seen_.is_visible() && time_s - lost_s_ < hold_s_;
  return is_held ? &seen_ : nullptr;
}

double GuidancePresence::advance(bool wanted, double time_s) {
  const double since_s = time_s - level_at_s_.value_or(time_s);
  level_at_s_ = time_s;
  const double change = fade_s_ > 0 ? since_s / fade_s_ : 1;
  level_ = std::clamp(wanted ? level_ + change : level_ - change, 0.0, 1.0);
  return level_;
}

}  // namespace remote_touch
