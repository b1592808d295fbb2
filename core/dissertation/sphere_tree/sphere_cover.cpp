#include "core/dissertation/sphere_tree/sphere_cover.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "core/geometry/bounding_box.h"
#include "core/numeric/counting_sort.h"

namespace remote_touch {

namespace {

constexpr double kMaxCellsOfBox = 1e7;  // a slim body along the diagonal of its box would need far more

}  // namespace

SphereCover::SphereCover(std::vector<Vec3> points, std::vector<Sphere> choice, double cell_m)
    : choice_(std::move(choice)), cell_m_(cell_m) {
  const BoundingBox box = points.empty() ? BoundingBox(Vec3(Vec3::Zero())) : bounding_box(points);
  low_ = box.min();
  const Vec3& high = box.max();
  while (((high - low_) / cell_m_ + Vec3::Ones()).prod() > kMaxCellsOfBox) cell_m_ *= 2;
  for (int axis = 0; axis < 3; ++axis)
    cells_[axis] = static_cast<std::int64_t>((high[axis] - low_[axis]) / cell_m_) + 1;
  const auto cell_of = [&](const Vec3& p) {
    return static_cast<std::size_t>((cell_along(2, p.z()) * cells_[1] + cell_along(1, p.y())) * cells_[0] +
                                    cell_along(0, p.x()));
  };
  starts_.resize(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1);
  points_.resize(points.size());
  std::vector<std::uint32_t> next(starts_.size());
  sort_by_cell(
      points.size(), starts_, next, [&](std::size_t i) { return cell_of(points[i]); },
      [&](std::size_t i, std::uint32_t to) { points_[to] = points[i]; });
}

// Returns the cell along an axis that contains x, or the nearest cell if x is outside the grid.
std::int64_t SphereCover::cell_along(int axis, double x) const {
  const double cell = std::clamp((x - low_[axis]) / cell_m_, 0.0, static_cast<double>(cells_[axis] - 1));
  return static_cast<std::int64_t>(cell);
}

template <class Act>
void SphereCover::within(const Sphere& sphere, const Act& act) const {
  std::int64_t first[3], last[3];
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = cell_along(axis, sphere.centre[axis] - sphere.radius_m);
    last[axis] = cell_along(axis, sphere.centre[axis] + sphere.radius_m);
  }
  const double squared = sphere.radius_m * sphere.radius_m;
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j) {
      // The cells of a row follow each other, and so do their points.
      const auto row = static_cast<std::size_t>((k * cells_[1] + j) * cells_[0]);
      const std::uint32_t begin = starts_[row + static_cast<std::size_t>(first[0])],
                          end = starts_[row + static_cast<std::size_t>(last[0]) + 1];
      for (std::uint32_t i = begin; i < end; ++i)
        if ((points_[i] - sphere.centre).squaredNorm() <= squared) act(i);
    }
}

// A sphere never covers more points than before, so a count from an earlier round is an upper bound. Only the
// sphere on top of the heap has to be counted again.
SphereCover::Result SphereCover::cover(double inflation_m, std::size_t max) const {
  struct Entry {
    std::uint32_t count, sphere;
    bool operator<(const Entry& other) const {
      return count != other.count ? count < other.count : sphere > other.sphere;
    }
  };
  std::vector<std::uint8_t> covered(points_.size(), 0);
  const auto grown = [&](std::uint32_t i) {
    return Sphere{choice_[i].centre, choice_[i].radius_m + inflation_m};
  };
  const auto count_of = [&](std::uint32_t i) {
    std::uint32_t count = 0;
    within(grown(i), [&](std::uint32_t point) { count += covered[point] ? 0 : 1; });
    return count;
  };
  std::vector<Entry> entries(choice_.size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t i = 0; i < choice_.size(); ++i)
    entries[i] = {count_of(static_cast<std::uint32_t>(i)), static_cast<std::uint32_t>(i)};
  std::priority_queue<Entry> heap({}, std::move(entries));
  Result result;
  result.uncovered_count = points_.size();
  while (!heap.empty() && result.uncovered_count > 0 && result.spheres.size() <= max) {
    Entry best = heap.top();
    heap.pop();
    const std::uint32_t now = count_of(best.sphere);
    if (now == 0) continue;
    if (now < best.count && !heap.empty() && Entry{now, best.sphere} < heap.top()) {
      best.count = now;
      heap.push(best);
      continue;
    }
    within(grown(best.sphere), [&](std::uint32_t point) { covered[point] = 1; });
    result.spheres.push_back(grown(best.sphere));
    result.uncovered_count -= now;
  }
  return result;
}

}  // namespace remote_touch
