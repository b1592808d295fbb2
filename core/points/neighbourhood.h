// The points around a moving proxy, gathered once and kept while the proxy stays near.
#pragma once

#include <array>
#include <memory>

#include "core/points/neighbour_search.h"

namespace remote_touch {

// A kept list belongs to a small cube of space, not to the path of the proxy: around() always returns the
// same points for a position, so results do not depend on history or on the search used. A few lists are
// kept, because a proxy on noisy points moves back and forth between neighbouring cubes.
class Neighbourhood {
 public:
  // reach (m): the list of a queried position holds every point with r_n <= reach, and some beyond.
  Neighbourhood(double reach, const Kernels& kernels);

  // Changes the reach. All kept lists become invalid.
  void set_reach(double reach);
  // Allocates memory for clouds of up to `points` points.
  void reserve(std::size_t points, bool with_radius, bool with_stiffness);
  // Replaces the cloud; all kept lists become invalid. Allocates if the cloud is the largest so far.
  void set_points(std::shared_ptr<const NeighbourSearch> points);
  // Returns the points around p. Valid until the next call.
  const GatheredPoints& around(const Vec3& p);
  // Returns the points of around(p); without most of those beyond the reach if p has moved little since the
  // last call. The points beyond the reach depend on earlier calls, so no result may depend on them. A narrow
  // list saves time because a slow proxy reads it in many steps. Valid until the next call.
  const GatheredPoints& narrowed(const Vec3& p);
  // Searches anew and returns all points with r_n <= radius of p, and possibly some beyond. Valid until the
  // next call.
  const GatheredPoints& within(const Vec3& p, double radius);
  // Returns the distance that a ball of the given radius can move from p along the unit vector u before it
  // meets a region, (4.9), (5.9), or limit if it meets none before. Tests the whole swept tube.
  double first_hit(const Vec3& p, const Vec3& u, double radius, double limit) {
    return first_hit(p, u, radius, limit, true);
  }
  // Returns the same distance for points without their r_f.
  double first_hit_of_points(const Vec3& p, const Vec3& u, double radius, double limit) {
    return first_hit(p, u, radius, limit, false);
  }

  bool has_regions() const { return points_->has_regions(); }

  // Returns M of kernels.h for sums over the present list.
  double sum_grid() const { return cache_[current_].sum_grid; }

 private:
  struct CachedList {
    Vec3 centre = Vec3::Zero();
    bool valid = false;
    double sum_grid = 1.5;
    GatheredPoints points = {};
  };
  void forget_lists();
  void gather(CachedList& kept);
  double first_hit(const Vec3& p, const Vec3& u, double radius, double limit, bool with_regions);

  double reach_;
  double pitch_;  // edge of the cubes
  double list_radius_;
  double narrow_margin_;
  const Kernels& kernels_;
  std::shared_ptr<const NeighbourSearch> points_;
  std::array<CachedList, 4> cache_;
  std::size_t current_ = 0;
  GatheredPoints tube_;  // gathered for one call
  // The points of cache_[narrow_of_] within the reach of any position nearer than narrow_margin_ to
  // narrow_.centre.
  CachedList narrow_;
  std::size_t narrow_of_ = 0;
  Vec3 last_W_ = Vec3::Zero();  // position in the last call of narrowed()
};

}  // namespace remote_touch
