// Covers many points by few spheres with a greedy algorithm: each next sphere is the one that covers most of
// the remaining points.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dissertation/sphere_tree/sphere_tree.h"

namespace remote_touch {

class SphereCover {
 public:
  // points: to be covered; choice: spheres to choose from; cell_m: cell size of the grid that finds points,
  // about the size of a sphere.
  SphereCover(std::vector<Vec3> points, std::vector<Sphere> choice, double cell_m);

  // Selects spheres of the choice, grown by inflation_m. It ends when every point is covered that any of them
  // covers, or when more than max are selected. If two spheres cover equally many points, the one that comes
  // first is selected.
  struct Result {
    std::vector<Sphere> spheres;
    std::size_t uncovered_count = 0;  // points that are not covered
  };
  Result cover(double inflation_m, std::size_t max) const;

 private:
  // Calls act(point) for the points in the sphere.
  template <class Act>
  void within(const Sphere& sphere, const Act& act) const;
  std::int64_t cell_along(int axis, double x) const;

  std::vector<Sphere> choice_;
  double cell_m_;
  Vec3 low_;
  std::int64_t cells_[3];
  std::vector<Vec3> points_;           // sorted by cell
  std::vector<std::uint32_t> starts_;  // first point of each cell; one more at the end
};

}  // namespace remote_touch
