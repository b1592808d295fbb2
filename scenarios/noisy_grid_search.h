// A flat grid whose noise is made only where it is asked for.
#pragma once

#include <vector>

#include "core/neighbour_search.h"
#include "core/noise.h"
#include "scenarios/grid.h"

namespace remote_touch {

// Points (x, height, z) of the grid, each coordinate plus sigma times a standard normal. The result is
// bit-identical to making every point, because a normal has a hard bound (kLargestNormal): points that start
// too far away cannot come near. Keeps the points made around the last place asked for, so it serves one
// reader at a time.
class NoisyGridSearch final : public NeighbourSearch {
 public:
  NoisyGridSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream);
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return static_cast<std::size_t>(grid_.size()); }

 private:
  struct Window {
    int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
    bool holds(const Window& w) const {
      return first_column <= w.first_column && last_column >= w.last_column && first_row <= w.first_row &&
             last_row >= w.last_row;
    }
  };
  Window window(const Ball& ball, double margin_m) const;
  void make(const Window& w, const Kernels& kernels) const;

  const Grid grid_;
  const double height_m_, sigma_m_;
  const NoiseStream stream_;
  mutable Window made_;
  mutable std::vector<std::uint32_t> index_;
  mutable std::vector<double> x_, y_, z_, nx_, ny_,
      nz_;  // room for all points, so that a query never allocates
};

}  // namespace remote_touch
