// The points of a tracked patch of surface, and sums over them, core/beyond/tracked_surface. Lengths are in
// units of the patch (PatchAxes::unit_m) unless they carry _m.
#pragma once

#include <cstdint>

#include "core/kernels/points_view.h"

namespace remote_touch {

// A number below 2^39 is rounded to a multiple of 2^-12 when this constant is added and subtracted again.
inline constexpr double kRoundsToPatchGrid = 0x1.8p40;

// The axes u, v, n of a patch of surface in the world, where n is its normal, and the cylinder of the patch
// about n. The origin is in m; radius and half height are in units of unit_m.
struct PatchAxes {
  double origin[3], u[3], v[3], n[3];
  double unit_m, radius, half_height;
};

// Positions in a patch: coordinates along its axes, and the indices of the points that they come from.
struct PatchColumns {
  double* u;
  double* v;
  double* h;
  std::uint32_t* source;
};

// Heights at the corners of square cells that cover |u|, |v| <= half; u runs fastest. cells: number along
// each axis; per_unit: cells per unit of length; last: largest coordinate in cells, slightly below their
// number, so that a position on the border lies in the last cell.
struct HeightGrid {
  const double* corner;
  int cells;
  double half, per_unit, last;
};

// Selects the positions within reach of (u, v) whose heights are within `off` of a plane. height: height of
// the plane at (0, 0).
struct NearPlane {
  double u, v, reach;
  double height, slope_u, slope_v, off;
};

// Bins of heights, each `width` wide, from -half_range upwards. number: number of bins.
struct HeightBins {
  double half_range, width;
  int number;
};

struct PlaneSums {
  double n, u, v, h, uu, uv, vv, uh, vh;
};

// power: sums of 1, u, v, uu, uv, vv, and of the products of third and fourth degree, in falling powers of u.
// with_h: sums of the first six of these terms multiplied by h.
struct QuadraticSums {
  double power[15], with_h[6];
};

struct PatchKernels {
  // Selects the points that lie in the cylinder of a patch, in order, and rounds their coordinates with
  // kRoundsToPatchGrid. A NaN point is in no cylinder. Returns their number; the columns have capacity for
  // padded_count.
  std::size_t (*points_of_patch)(const PointsView&, const PatchAxes&, const PatchColumns&);
  // Computes the height of each position above the grid's heights, which are bilinear in each cell. A
  // position beyond the border is compared with the height at the nearest position on the border.
  void (*heights_above)(const PatchColumns&, std::size_t count, const HeightGrid&, double* above);
  // Computes sums over the positions near a plane. They are exact for positions on the grid of
  // kRoundsToPatchGrid; heights are rounded to that grid. NaN heights are excluded.
  PlaneSums (*sums_near_plane)(const PatchColumns&, std::size_t count, const double* height,
                               const NearPlane&);
  // Writes the bin of the height of each position within reach of (u, v). The value is bins.number for
  // positions farther away and for heights outside the bins.
  void (*height_bins)(const PatchColumns&, std::size_t count, const double* height, double u, double v,
                      double reach, const HeightBins&, std::int32_t* bin);
  // Computes sums over the members within a radius of (0, 0). They are exact, because uu, uv and vv are first
  // rounded to the grid of kRoundsToPatchGrid.
  QuadraticSums (*sums_of_quadratic)(const PatchColumns&, const std::uint8_t* member, std::size_t count,
                                     double radius);
};

}  // namespace remote_touch
