// The nearest neighbours of a position in a frame, for methods that adapt to the density of the points.
#pragma once

#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/search/gathered_points.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

class NearestPoints {
 public:
  explicit NearestPoints(const Kernels& kernels) : kernels_(kernels) {}

  // Allocates memory for clouds of this number of points.
  void reserve(std::size_t points);
  // Finds the `count` points nearest to p. p itself is included if it is a point. If there are fewer within
  // 0.5 m, it finds all of these. The set is the same for every order of the points: points as far away as
  // the last one belong to it too. Returns the distance of the last one; 0 if no point was found. Allocates
  // only for a cloud larger than reserved.
  double find(const NeighbourSearch& points, const Vec3& p_W, int count);
  // Calls act(x - p) for each point of the set found last.
  template <class Act>
  void for_each(const Act& act) const {
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (squared_[i] <= limit_) act(Vec3(offset(i)));
  }

 private:
  Vec3 offset(std::size_t i) const;
  std::size_t gather(const NeighbourSearch& points, double radius);

  const Kernels& kernels_;
  GatheredPoints near_;
  Buffer<double> squared_, sorted_;
  Vec3 p_W_ = Vec3::Zero();
  double limit_ = 0;         // largest squared distance of a point of the set
  double radius_m_ = 0.004;  // radius of the first ball, from the last search
};

// Returns the mean over the points of the mean distance to the three nearest other points: for a square grid
// without noise this is its spacing. A cloud of 20000 points or more is sampled. Returns 0 if there are fewer
// than four points. The order of the points has no effect. buffer: for a search without a stored cloud.
double mean_spacing_m(const NeighbourSearch& points, NearestPoints& nearest, const Kernels& kernels,
                      PointCloud& buffer);

}  // namespace remote_touch
