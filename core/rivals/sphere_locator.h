// Finds the sphere that contains a position, among spheres that do not overlap.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"

namespace remote_touch {

class SphereLocator {
 public:
  // Sorts the spheres into the cells of a grid around them: 96 along its longest side. Keeps the spheres by
  // reference. pre: at least one sphere, all finite and with a radius above 0.
  explicit SphereLocator(std::span<const Sphere> spheres);

  // Returns the number of the sphere whose centre is nearer to p than its radius; the lowest number if
  // rounding makes two spheres overlap. p is in the frame of the spheres and may be NaN. Does not allocate.
  std::optional<std::uint32_t> at(const Vec3& p) const;

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Vec3& p) const;
  std::size_t index(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * cells_[1] + j) * cells_[0] + i);
  }
  template <class Act>
  void for_cells_of(const Sphere& sphere, const Act& act) const;

  std::span<const Sphere> spheres_;
  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Zero();
  double cell_m_ = 1;
  Cell cells_{1, 1, 1};
  std::vector<std::uint32_t> first_;   // first entry of each cell in number_; one more at the end
  std::vector<std::uint32_t> number_;  // spheres that reach into each cell, in rising order
};

}  // namespace remote_touch
