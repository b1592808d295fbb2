#include "core/search/gathered_points.h"

namespace remote_touch {

void GatheredPoints::reserve(std::size_t cloud_size, bool with_radius, bool with_stiffness) {
  const std::size_t capacity = cloud_size + 2 * kLanes;
  x_.grow(capacity), y_.grow(capacity), z_.grow(capacity), index_.grow(capacity);
  if (with_radius) radius_.grow(capacity);
  if (with_stiffness) stiffness_.grow(capacity);
  with_radius_ = with_radius, with_stiffness_ = with_stiffness;
}

void GatheredPoints::add(const PointRun& run, const Ball& ball, const Kernels& kernels) {
  const PointSink sink{x_.data(), y_.data(), z_.data(), radius_.data(), stiffness_.data(), index_.data()};
  count_ = kernels.gather.append_within(run, ball.centre.data(), ball.radius, sink, count_);
}

void GatheredPoints::finish() {
  for (std::size_t i = count_; i % kLanes != 0; ++i) {
    x_[i] = y_[i] = z_[i] = kFarAway;
    if (with_radius_) radius_[i] = 0;
    if (with_stiffness_) stiffness_[i] = 0;
  }
}

PointsView GatheredPoints::view() const {
  const std::size_t padded = (count_ + kLanes - 1) / kLanes * kLanes;
  return {x_.data(),
          y_.data(),
          z_.data(),
          with_radius_ ? radius_.data() : nullptr,
          with_stiffness_ ? stiffness_.data() : nullptr,
          padded};
}

PointRun GatheredPoints::run() const {
  const PointsView columns = view();
  return {columns.x, columns.y, columns.z, columns.radius, columns.stiffness, index_.data(), 0, count_};
}

}  // namespace remote_touch
