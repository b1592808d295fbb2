#include "runners/experiment/hand/polyline_path.h"

#include <algorithm>

namespace remote_touch {

void PolylinePath::go_to(const Vec3& p, double speed_m_per_s) {
  const double duration = speed_m_per_s > 0 ? (p - points_.back()).norm() / speed_m_per_s : 0;
  arrival_s_.push_back(arrival_s_.back() + duration);
  points_.push_back(p);
}

void PolylinePath::wait(double duration_s) {
  arrival_s_.push_back(arrival_s_.back() + duration_s);
  points_.push_back(points_.back());
}

Vec3 PolylinePath::at(double time_s) const {
  // The first point that is reached after time_s. At the time of a jump the device is at the end of the jump.
  const auto next = std::upper_bound(arrival_s_.begin(), arrival_s_.end(), time_s);
  if (next == arrival_s_.end()) return points_.back();
  if (next == arrival_s_.begin()) return points_.front();
  const auto i = static_cast<std::size_t>(next - arrival_s_.begin());
  const double fraction = (time_s - arrival_s_[i - 1]) / (arrival_s_[i] - arrival_s_[i - 1]);
  return points_[i - 1] + fraction * (points_[i] - points_[i - 1]);
}

}  // namespace remote_touch
