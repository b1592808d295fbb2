// The points of a tracked patch of surface, and sums over them, core/tracked_sheet. Lengths in units of the
// patch (PatchAxes::unit_m) unless they carry _m.
#pragma once

#include <cstdint>

#include "core/kernels/points_view.h"

namespace remote_touch {

// Rounds a number below 2^39 to a multiple of 2^-12 when it is added and taken away.
inline constexpr double kRoundsToPatchGrid = 0x1.8p40;

// The axes of a patch of surface in the world, n its normal, and its cylinder about n: origin in m, radius
// and half height in units of unit_m.
struct PatchAxes {
  double origin[3], u[3], v[3], n[3];
  double unit_m, radius, half_height;
};

// Places of a patch, and the rows that they come from.
struct PatchColumns {
  double* u;
  double* v;
  double* h;
  std::uint32_t* source;
};

// Heights at the corners of square cells over |u|, |v| <= half, u running fastest. last: largest coordinate
// in cells, just below their number, so that a place on the border lies in the last cell.
struct HeightGrid {
  const double* corner;
  int cells;
  double half, per_unit, last;
};

// Selects the places within reach of (u, v) whose heights are within off of a plane, which has its height at
// (0, 0).
struct NearPlane {
  double u, v, reach;
  double height, slope_u, slope_v, off;
};

// Bins of heights, width apart, from -half_range on; number counts the bins.
struct HeightBins {
  double half_range, width;
  int number;
};

struct PlaneSums {
  double n, u, v, h, uu, uv, vv, uh, vh;
};

// Sums of 1, u, v, uu, uv, vv, and of the products of third and fourth degree, the powers of u falling; and
// of the first six times h.
struct QuadraticSums {
  double power[15], with_h[6];
};

struct PatchKernels {
  // The points that lie in a patch's cylinder, in order, their coordinates rounded to kRoundsToPatchGrid; NaN
  // lies in none. Returns how many; the columns have the capacity for padded_count.
  std::size_t (*points_of_patch)(const PointsView&, const PatchAxes&, const PatchColumns&);
  // How far each place lies above the heights, which are bilinear in each cell; beyond the border they are
  // those of the nearest place on it.
  void (*heights_above)(const PatchColumns&, std::size_t count, const HeightGrid&, double* above);
  // Exact for places and heights on the grid above, to which the heights are rounded; NaN is left out.
  PlaneSums (*sums_near_plane)(const PatchColumns&, std::size_t count, const double* height,
                               const NearPlane&);
  // Of each place no farther than reach from (u, v) the bin that its height lies in; of other places, and of
  // heights in none, the number of bins.
  void (*height_bins)(const PatchColumns&, std::size_t count, const double* height, double u, double v,
                      double reach, const HeightBins&, std::int32_t* bin);
  // Of the members within a radius of (0, 0); exact, since uu, uv, vv are rounded to the grid first.
  QuadraticSums (*sums_of_quadratic)(const PatchColumns&, const std::uint8_t* member, std::size_t count,
                                     double radius);
};

}  // namespace remote_touch
