// The points around a moving proxy, gathered once and kept while the proxy stays near.
#pragma once

#include <array>
#include <memory>

#include "core/search/gathered_points.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

// A kept list belongs to a small cube of space, not to the path of the proxy: a position always gets the same
// list, so results do not depend on history or on the search used. A few lists are kept, because a proxy on
// noisy points moves back and forth between neighbouring cubes.
class Neighbourhood {
 public:
  // reach: every point with r_n <= reach, m, of the queried position is in the list (and some beyond).
  Neighbourhood(double reach, const Kernels& kernels);

  // Another reach from now on.
  void set_reach(double reach);
  // Allocates for clouds of so many points.
  void reserve(std::size_t points, bool with_radius, bool with_stiffness);
  // A new cloud. Allocates when it is the largest so far.
  void set_points(std::shared_ptr<const NeighbourSearch> points);
  // The points around p. Valid until the next call.
  const GatheredPoints& around(const Vec3& p);
  // All points with r_n <= radius of p, gathered anew, and some beyond. Valid until the next call.
  const GatheredPoints& within(const Vec3& p, double radius);
  // (4.9), (5.9): how far a ball of that radius moves from p along the unit vector u before it meets a point;
  // limit when nothing is met before. Tests the whole swept tube.
  double first_hit(const Vec3& p, const Vec3& u, double radius, double limit);

  bool has_regions() const { return points_->has_regions(); }

  // M of kernels.h for sums over the present list.
  double sum_grid() const { return cache_[current_].sum_grid; }

 private:
  struct CachedList {
    Vec3 centre = Vec3::Zero();
    bool valid = false;
    double sum_grid = 1.5;
    GatheredPoints points = {};
  };
  void gather(CachedList& kept);

  double reach_;
  double pitch_;  // edge of the cubes
  double list_radius_;
  const Kernels& kernels_;
  std::shared_ptr<const NeighbourSearch> points_;
  std::array<CachedList, 4> cache_;
  std::size_t current_ = 0;
  GatheredPoints tube_;  // gathered for one call
};

}  // namespace remote_touch
