#include "core/rivals/sphere_locator.h"

#include <algorithm>

#include "core/geometry/vector.h"

namespace remote_touch {

namespace {

constexpr double kCellsAlong = 96;
// A sphere is entered in every cell that it reaches if it is larger by this fraction of a cell. So rounding
// at the boundary of a cell cannot lose it.
constexpr double kSlack = 1e-6;

}  // namespace

SphereLocator::SphereLocator(std::span<const Sphere> spheres) : spheres_(spheres) {
  BoundingBox box;
  for (const Sphere& sphere : spheres)
    box.extend(sphere.centre - Vec3::Constant(sphere.radius_m))
        .extend(sphere.centre + Vec3::Constant(sphere.radius_m));
  low_ = box.min(), high_ = box.max();
  cell_m_ = box.sizes().maxCoeff() / kCellsAlong;
  for (int axis = 0; axis < 3; ++axis)
    cells_[static_cast<std::size_t>(axis)] =
        static_cast<std::int64_t>((high_[axis] - low_[axis]) / cell_m_) + 1;
  first_.assign(index(0, 0, cells_[2]) + 1, 0);
  for (const Sphere& sphere : spheres) for_cells_of(sphere, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell + 1] += first_[cell];
  number_.resize(first_.back());
  std::vector<std::uint32_t> next = first_;
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    for_cells_of(spheres[i], [&](std::size_t cell) { number_[next[cell]++] = i; });
}

// Returns the cell that contains p, or the nearest cell if p is outside the grid. pre: p is finite.
SphereLocator::Cell SphereLocator::cell_of(const Vec3& p) const {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double last = static_cast<double>(cells_[i] - 1);
    cell[i] = static_cast<std::int64_t>(std::clamp((p[axis] - low_[axis]) / cell_m_, 0.0, last));
  }
  return cell;
}

// Calls act(index) for every cell that the sphere reaches.
template <class Act>
void SphereLocator::for_cells_of(const Sphere& sphere, const Act& act) const {
  const double reach_m = sphere.radius_m + kSlack * cell_m_;
  const Cell first = cell_of(sphere.centre - Vec3::Constant(reach_m)),
             last = cell_of(sphere.centre + Vec3::Constant(reach_m));
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
      for (std::int64_t i = first[0]; i <= last[0]; ++i) {
        const Vec3 corner =
            low_ + cell_m_ * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const Vec3 nearest = sphere.centre.cwiseMax(corner).cwiseMin(corner + Vec3::Constant(cell_m_));
        if ((nearest - sphere.centre).squaredNorm() <= reach_m * reach_m) act(index(i, j, k));
      }
}

std::optional<std::uint32_t> SphereLocator::at(const Vec3& p) const {
  // NaN fails the comparison.
  if (!((p.array() >= low_.array()).all() && (p.array() <= high_.array()).all())) return {};
  const Cell cell = cell_of(p);
  const std::size_t here = index(cell[0], cell[1], cell[2]);
  for (std::uint32_t i = first_[here]; i < first_[here + 1]; ++i) {
    const Sphere& sphere = spheres_[number_[i]];
    if ((p - sphere.centre).squaredNorm() < sphere.radius_m * sphere.radius_m) return number_[i];
  }
  return {};
}

}  // namespace remote_touch
