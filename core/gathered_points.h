// The points near the proxy, copied side by side into columns that the kernels read.
#pragma once

#include <cstdint>
#include <vector>

#include "core/kernels.h"
#include "core/vector.h"

namespace remote_touch {

struct Ball {
  Vec3 centre;
  double radius;
};

// Columns are allocated once, by reserve(); adding and clearing never allocate. The order of the points is
// whatever the search produced: no result depends on it.
class GatheredPoints {
 public:
  // Room for every point of a cloud. Keeps what it has when that is enough.
  void reserve(std::size_t cloud_size, bool with_radius, bool with_stiffness);
  void clear() { count_ = 0; }
  // Appends those points of the run that lie in the ball. pre: reserve() for the run's cloud.
  void add(const PointRun& run, const Ball& ball, const Kernels& kernels);
  // Pads to whole lanes; to be called once after the last add().
  void finish();

  std::size_t size() const { return count_; }
  const std::uint32_t* index() const { return index_.data(); }
  PointsView view() const;

 private:
  std::size_t count_ = 0;
  bool with_radius_ = false, with_stiffness_ = false;
  std::vector<double> x_, y_, z_, radius_, stiffness_;
  std::vector<std::uint32_t> index_;
};

}  // namespace remote_touch
