// The points of a tracked patch of surface, and sums over them, core/beyond/tracked_surface. Lengths are in
// units of the patch (PatchAxes::unit_m) unless they carry _m.
#pragma once

#include <cstdint>

#include "core/kernels/points_view.h"

namespace remote_touch {

// Added to a number below 2^39 and subtracted again, it rounds the number to a multiple of 2^-12.
inline constexpr double kRoundsToPatchGrid = 0x1.8p40;

// The axes of a patch of surface in the world, n its normal, and its cylinder about n: origin in m, radius
// and half height in units of unit_m.
struct PatchAxes {
  double origin[3], u[3], v[3], n[3];
  double unit_m, radius, half_height;
};

// Positions in a patch, and the rows of the points that they come from.
struct PatchColumns {
  double* u;
  double* v;
  double* h;
  std::uint32_t* source;
};

// Heights at the corners of square cells over |u|, |v| <= half, u running fastest. last: largest coordinate
// in cells, just below their number, so that a position on the border lies in the last cell.
struct HeightGrid {
  const double* corner;
  int cells;
  double half, per_unit, last;
};

// Selects the positions within reach of (u, v) whose heights are within `off` of a plane. The plane has the
// given height at (0, 0).
struct NearPlane {
  double u, v, reach;
  double height, slope_u, slope_v, off;
};

// Bins of heights, each `width` wide, from -half_range on; number counts the bins.
struct HeightBins {
  double half_range, width;
  int number;
};

struct PlaneSums {
  double n, u, v, h, uu, uv, vv, uh, vh;
};

// Sums of 1, u, v, uu, uv, vv, and of the products of third and fourth degree, in falling powers of u; and
// the sums of the first six multiplied by h.
struct QuadraticSums {
  double power[15], with_h[6];
};

struct PatchKernels {
  // Selects the points that lie in a patch's cylinder, in order, and rounds their coordinates with
  // kRoundsToPatchGrid. NaN lies in no cylinder. Returns their number; the columns have the capacity for
  // padded_count.
  std::size_t (*points_of_patch)(const PointsView&, const PatchAxes&, const PatchColumns&);
  // Computes the height of each position above the grid's heights, which are bilinear in each cell. Beyond
  // the border they are those of the nearest position on it.
  void (*heights_above)(const PatchColumns&, std::size_t count, const HeightGrid&, double* above);
  // Sums over the positions near a plane. They are exact for positions on the grid above; heights are rounded
  // to it. NaN is left out.
  PlaneSums (*sums_near_plane)(const PatchColumns&, std::size_t count, const double* height,
                               const NearPlane&);
  // Writes the bin of the height of each position no farther than reach from (u, v). Positions farther away,
  // and heights in no bin, get the number of bins.
  void (*height_bins)(const PatchColumns&, std::size_t count, const double* height, double u, double v,
                      double reach, const HeightBins&, std::int32_t* bin);
  // Sums over the members within a radius of (0, 0); exact, since uu, uv, vv are rounded to the grid first.
  QuadraticSums (*sums_of_quadratic)(const PatchColumns&, const std::uint8_t* member, std::size_t count,
                                     double radius);
};

}  // namespace remote_touch
