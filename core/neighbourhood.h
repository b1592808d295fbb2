// The points around a moving proxy, gathered once and kept while the proxy stays near.
#pragma once

#include <memory>

#include "core/gathered_points.h"
#include "core/neighbour_search.h"

namespace remote_touch {

// The kept list belongs to a small cube of space, not to the way the proxy came: a position always meets the
// same list, so results do not depend on history or on the search used.
class Neighbourhood {
 public:
  // reach: every point with r_n <= reach of the position asked about is in the list (and some beyond).
  Neighbourhood(double reach, const Kernels& kernels);

  // A new cloud. Allocates when it is the largest so far.
  void set_points(std::shared_ptr<const NeighbourSearch> points);
  // The points around p. Valid until the next call.
  const GatheredPoints& around(const Vec3& p);
  // (4.9), (5.9): how far a ball of that radius moves from p along the unit vector u before it meets a point;
  // limit when nothing is met before. Looks at the whole swept tube.
  double first_hit(const Vec3& p, const Vec3& u, double radius, double limit);

  // M of kernels.h for sums over the present list.
  double sum_grid() const { return sum_grid_; }

 private:
  double reach_;
  double pitch_;  // edge of the cubes
  const Kernels& kernels_;
  std::shared_ptr<const NeighbourSearch> points_;
  GatheredPoints list_, tube_;
  Vec3 list_centre_ = Vec3::Zero();
  double list_radius_ = 0;
  bool list_valid_ = false;
  double sum_grid_ = 1.5;
};

}  // namespace remote_touch
