#include "core/rivals/block_search.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

namespace {

constexpr std::size_t kBlock = 128;

}  // namespace

void BlockSearch::reserve(std::size_t points) {
  for (std::vector<double>* column : {&x_, &y_, &z_, &radius_, &stiffness_}) column->reserve(points);
  boxes_.reserve(points / kBlock + 1);
}

void BlockSearch::clear(std::size_t points, int columns, bool with_radius, bool with_stiffness) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  for (std::vector<double>* column : {&x_, &y_, &z_}) column->assign(points, kNoNumber);
  radius_.assign(with_radius ? points : 0, 0);
  stiffness_.assign(with_stiffness ? points : 0, kNoNumber);
  columns_ = columns;
}

void BlockSearch::finish() {
  max_radius_m_ = 0;
  for (const double radius : radius_) max_radius_m_ = std::max(max_radius_m_, radius);
  boxes_.clear();
  for (std::size_t first = 0; first < size(); first += kBlock) {
    BoundingBox box;
    for (std::size_t i = first; i < std::min(first + kBlock, size()); ++i)
      if (const Vec3 p(x_[i], y_[i], z_[i]); p.allFinite()) box.extend(p);
    boxes_.push_back(box);
  }
}

void BlockSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const double reach = (ball.radius + max_radius_m_) * (1 + 1e-9);
  for (std::size_t block = 0; block < boxes_.size(); ++block) {
    const BoundingBox& box = boxes_[block];
    if (box.isEmpty() || box.squaredExteriorDistance(ball.centre) > reach * reach) continue;
    const std::size_t first = block * kBlock, count = std::min(kBlock, size() - first);
    out.add({x_.data() + first, y_.data() + first, z_.data() + first,
             has_fixture_radius() ? radius_.data() + first : nullptr,
             has_stiffness() ? stiffness_.data() + first : nullptr, nullptr,
             static_cast<std::uint32_t>(first), count},
            ball, kernels);
  }
}

}  // namespace remote_touch
