#include "runners/experiment/teleoperation/frame_link.h"

#include "core/teleoperation/channel.h"

namespace remote_touch {

// Forgets older positions: a frame that is older than another one is dropped, so they are not asked for.
std::optional<Vec3> FrameSender::slave_at(double time_s) {
  while (slave_.size() > 1 && slave_[1].first <= time_s + kSameArrival_s) slave_.pop_front();
  if (slave_.empty() || slave_.front().first > time_s + kSameArrival_s) return {};
  return slave_.front().second;
}

}  // namespace remote_touch
