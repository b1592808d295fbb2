// A flat grid whose noise is computed only where a query needs it.
#pragma once

#include "core/numeric/noise.h"
#include "core/search/neighbour_search.h"
#include "scenarios/synthetic/grid.h"

namespace remote_touch {

// Points (x, height, z) of the grid, each coordinate plus sigma times a standard normal. The result is
// bit-identical to computing every point. A normal has a hard bound (kMaxNormal), so a grid point that is too
// far away cannot move near. Of the other points, only those are computed whose random words allow a
// displacement that is large enough. The points around the last query are cached, and those nearest to it
// once more, so a search serves one reader at a time.
class NoisyGridSearch final : public NeighbourSearch {
 public:
  NoisyGridSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream);
  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return static_cast<std::size_t>(grid_.size()); }
  int organised_columns() const override { return grid_.columns; }

 private:
  // Points at any height whose x and z lie within radius_m of the axis.
  struct Cylinder {
    double x = 0, z = 0, radius_m = -1;
    // Distance of p from the border, along x and z; negative outside.
    double margin_m(const Vec3& p) const;
  };
  struct Range {
    int first, last;
  };
  static Range within(double centre, double reach, double start, double spacing, int count);
  void make(const Cylinder& cylinder, const Kernels& kernels) const;
  void make_points(std::size_t candidates, const Cylinder& cylinder, const Kernels& kernels) const;
  PointRun run(std::size_t first, std::size_t count) const;
  PointRun near(const Ball& ball, const Kernels& kernels) const;

  const Grid grid_;
  const double height_m_, sigma_m_;
  const NoiseStream stream_;
  // Allocated for all points, so that a query never allocates.
  mutable Cylinder cached_cylinder_;
  mutable Ball near_ball_{Vec3::Zero(), -1};
  mutable std::size_t count_ = 0, near_count_ = 0;  // the near points are stored behind the others
  mutable Buffer<std::uint32_t> index_;
  mutable Buffer<std::uint64_t> x_bounds_, z_bounds_;
  mutable Buffer<double> x_, y_, z_;
};

}  // namespace remote_touch
