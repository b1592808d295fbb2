#include "runners/experiment/teleoperation/frame_link.h"

#include <limits>

#include "core/teleoperation/channel.h"

namespace remote_touch {

// Forgets older positions: a renderer drops a frame that is older than another one, whatever is sent.
Vec3 FrameSender::slave_at(double time_s) {
  while (slave_.size() > 1 && slave_[1].first <= time_s + kSameArrival_s) slave_.pop_front();
  const bool is_known = !slave_.empty() && slave_.front().first <= time_s + kSameArrival_s;
  return is_known ? slave_.front().second : Vec3(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace remote_touch
