// The kernels on points: noise, gathering, patches of tracked sheets, regions near a leaf of a tool, and the
// queries of the proxy.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/kernels/kernels.h"

namespace remote_touch {

// Columns in m. They need no alignment. They are padded with points at kFarAway to padded_count, a multiple
// of kLanes. radius is r_f of each point and stiffness is k_s in N/m (NaN: the renderer's own); both are null
// if the cloud has no such column.
struct PointsView {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
  const double* stiffness;
  std::size_t padded_count;
};

// Standard normals of the counter-based generator; core/points/noise.h defines its keys.

// Counter and key of the generator.
struct NoiseStream {
  std::uint32_t key[2];
  std::uint32_t counter[3];  // the generator's counter without its first word, which is the point's index
};

// Points of an organised cloud: point (column, row) has the index first + row * stride + column. stride is at
// least columns.
struct PointRectangle {
  std::uint32_t first, stride;
  std::size_t columns, rows;
};

struct NoiseKernels {
  // Computes three standard normals for each of the points index[0..count), by the method of Box and Muller.
  void (*normals)(const NoiseStream&, const std::uint32_t* index, std::size_t count, double* x, double* y,
                  double* z);
  // Selects the points of a rectangle whose random words allow the x normal to meet the bound x[column] and
  // the z normal to meet the bound z[row] (word_bounds() in noise.h). A point that is not selected misses at
  // least one of the bounds. Stores the indices of the selected points, increasing, and returns their number.
  // pre: x has kLanes elements behind those of the columns, with any values; index has capacity for kLanes
  // more than the points of the rectangle.
  std::size_t (*candidates)(const NoiseStream&, const PointRectangle&, const std::uint64_t* x,
                            const std::uint64_t* z, std::uint32_t* index);
};

// Copies the points in a ball from the runs that a neighbour search visits, 4.2.2 and 5.2. Lengths in m.

// The points that a neighbour search tests: `count` consecutive points of the columns; in an image `rows`
// such rows, whose first points are `stride` apart. No alignment or padding is required.
struct PointRun {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;        // may be null
  const double* stiffness;     // may be null
  const std::uint32_t* index;  // null: the index is first_index + offset from the first point
  std::uint32_t first_index;
  std::size_t count;
  std::size_t rows = 1;
  std::size_t stride = 0;
};

// The columns to append to. Each has capacity for every point of the cloud and kLanes more. radius and
// stiffness are written only if the run has them.
struct PointSink {
  double* x;
  double* y;
  double* z;
  double* radius;
  double* stiffness;
  std::uint32_t* index;
};

struct GatherKernels {
  // Appends the points of the run with |x - centre|^2 <= (reach + r_f)^2, all in double; NaN never qualifies.
  // Returns the new count.
  std::size_t (*append_within)(const PointRun&, const double centre[3], double reach, const PointSink&,
                               std::size_t count);
};

// The points of a tracked patch of surface, and sums over them, core/beyond/tracked_surface. Lengths are in
// units of the patch (PatchAxes::unit_m) unless they carry _m.

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

// Detection between a leaf of a tool's sphere tree and forbidden regions, 7.4.1, and selection of the pairs
// that become constraints, 7.4.2. Lengths in m.

// Spheres with the numbers first, first + 1, ..., padded with far-away spheres of radius 0 to a multiple of
// kLanes. low, high and max_radius belong to groups of kLanes spheres: the box around their centres and their
// largest radius, without the padding. These columns are padded with far-away groups to a multiple of kLanes
// too.
struct SphereRun {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
  const double* low[3];
  const double* high[3];
  const double* max_radius;
  std::size_t padded_groups;
  std::uint32_t first;
};

// Regions near a leaf of a tool. gap: distance between both surfaces, negative if they overlap; (nx, ny, nz):
// unit normal out of the region, world frame (+y if the centres coincide); number: number of the region. Each
// column has capacity for all regions and 2 kLanes more.
struct NearRegions {
  double* gap;
  double* nx;
  double* ny;
  double* nz;
  std::uint32_t* number;
};

// count: number of remaining regions in the columns; deepest: index of the one with the smallest gap, or
// count if there is none.
struct RemainingRegions {
  std::size_t deepest, count;
};

struct RegionKernels {
  // Appends the spheres of a run whose gap to a leaf (x, y, z, radius) is at most margin, 7.4.1. Returns the
  // new count. The gap is |leaf - sphere| minus the leaf's radius minus the sphere's, in this order; a NaN
  // gap is never appended.
  std::size_t (*append_near_regions)(const SphereRun&, const double leaf[4], double margin,
                                     const NearRegions&, std::size_t count);
  // Returns the first index with the smallest gap; count (0) if there are no regions. Fills the last group of
  // gaps up with infinity.
  std::size_t (*deepest_region)(const NearRegions&, std::size_t count);
  // Removes region `kept`, the regions that it makes redundant, and the regions with gaps above max. `kept`
  // must be the deepest region. It makes another one redundant if the cosine between both normals is at least
  // `alike`, and if no motion of the leaf up to the length `motion` that obeys `kept` violates the other one.
  // Removed regions have infinite gaps. When they are many, the others are moved together in the same order,
  // except in the column `number`, which is not valid afterwards. Call it after deepest_region().
  RemainingRegions (*next_deepest_region)(const NearRegions&, std::size_t count, std::size_t kept,
                                          double motion, double alike, double max);
};

// Queries of the points near the proxy: the state of the proxy, its normal, its stiffness and its step sizes.
// Positions and radii are in m, directions have unit length.

// The radii that define the proxy's regions, Fig 4.2, and the constants of the sums over the points.
struct ProxyRegions {
  double r1, r2, r3;
  double sum_grid;   // M of kernels.h: 1.5 times a power of two, and at least 1.5 times the number of points
  double stiffness;  // stiffness of points without their own, N/m
};

// Local statistics of the points around a proxy position. r_n = |P - x| - r_f, (5.5).
struct ContactQuery {
  double nearest;         // smallest r_n; infinite without points
  double normal_sum[3];   // (4.1): sum of (P - x)/|P - x| psi(r_n), not of unit length
  double weight_sum;      // sum of psi(r_n); 0 if the points have no stiffness column
  double stiffness_sum;   // (5.8): sum of k_s psi(r_n); 0 if the points have no stiffness column
  double touching_count;  // number of points with r_n <= r2
};

struct ProxyKernels {
  ContactQuery (*contact_query)(const PointsView&, const double p[3], const ProxyRegions&);
  // Returns the smallest d > 0 at which a proxy that moves from p along the unit vector meets a point ahead,
  // |p + d direction - x| = reach + r_f, (4.9), (5.9); infinity if it meets none.
  double (*first_hit)(const PointsView&, const double p[3], const double direction[3], double reach);
  // Returns the largest positive root over the points with r_n < inner, (4.10), (5.11); 0 without such
  // points.
  double (*exit_distance)(const PointsView&, const double p[3], const double direction[3], double reach,
                          double inner);
};

}  // namespace remote_touch
