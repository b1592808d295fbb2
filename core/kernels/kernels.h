// The inner loops over gathered points, compiled once for each x86-64 level and chosen at run time.
//
// The same bits on every level, for every order of the points: every term is computed by itself in IEEE
// double without contraction, minima and maxima do not depend on order, and sums are exact. A sum is exact
// because each term is first rounded to a fixed grid: with M = 1.5 * 2^m, (t + M) - M rounds t to a multiple
// of 2^(m-52), and up to 2^m terms of magnitude at most 1 then add without rounding (pre-rounding, Demmel and
// Nguyen 2013). The price is an absolute error of 2^(m-53) a term, 1.5e-14 for 256 points.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/kernels/image_rows.h"

namespace remote_touch {

// A view of gathered points, padded with far-away points to a multiple of kLanes. radius is r_f of each point
// and stiffness k_s (NaN: the renderer's own); both are null where the cloud has no such column.
struct PointsView {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
  const double* stiffness;
  std::size_t padded_count;
};

inline constexpr std::size_t kLanes = 8;
inline constexpr double kFarAway = 1e100;  // coordinate of a padding point; its square is still finite

// The radii that define the proxy's regions, Fig 4.2, and what the sums over the points need.
struct ProxyRegions {
  double r1, r2, r3;
  double sum_grid;   // M above, at least 1.5 * the number of points, a power of two times 1.5
  double stiffness;  // of points without one of their own
};

// Local statistics of the points around a proxy position. r_n = |P - x| - r_f, (5.5).
struct ContactQuery {
  double nearest;        // smallest r_n; infinite without points
  double normal_sum[3];  // (4.1): sum of (P - x)/|P - x| psi(r_n), not normalised
  double weight_sum;     // sum of psi(r_n), points with a stiffness only
  double stiffness_sum;  // (5.8): sum of k_s psi(r_n)
  double touching;       // number of points with r_n <= r2
};

// Stored points with consecutive positions in the columns, as a neighbour search hands them over: count of
// them, or, in an image, rows of count, whose first points are stride apart.
struct PointRun {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;        // may be null
  const double* stiffness;     // may be null
  const std::uint32_t* index;  // null: first_index, first_index + 1, ...
  std::uint32_t first_index;
  std::size_t count;
  std::size_t rows = 1;
  std::size_t stride = 0;
};

// Columns to append to; each has room for every point of the cloud plus kLanes.
struct PointSink {
  double* x;
  double* y;
  double* z;
  double* radius;
  double* stiffness;
  std::uint32_t* index;
};

// Counter and key of the noise generator; see noise.h.
struct NoiseStream {
  std::uint32_t key[2];
  std::uint32_t counter[3];  // the generator's counter without its first word, which is the point's index
};

// Bytes for the cells of a regular grid, the first coordinate running fastest; three bytes more can be read
// behind the last.
struct CellTable {
  const std::int8_t* value;
  int cells[3];
};

// From world coordinates to those of the cells: row[0..2] . (x, y, z) + row[3] along each axis.
struct CellTransform {
  double row[3][4];
};

// Centres and radii.
struct SphereColumns {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
};

// A table of distances: no place of a cell is nearer to the tool than (zero - value) unit, in cells. What is
// looked for lies no farther than reach, in cells; radii in metres are to be multiplied by per_m.
struct NearnessCode {
  double zero, unit;
  double reach, per_m;
};

// Points with normals (NaN: none) and distances to the points around them.
struct PointColumns {
  const double* x;
  const double* y;
  const double* z;
  const double* nx;
  const double* ny;
  const double* nz;
  const double* spacing;
};

// Where a tool is, and its distance field at the nodes of a grid, the first coordinate running fastest.
struct PosedField {
  double R_TW[3][3];
  double p_W[3];
  const float* node;
  int cells[3];
  double origin_T[3];
  double size;
};

// Spheres with consecutive numbers, first of all the one that is named; padded with far-away ones of radius 0
// to a multiple of kLanes. Of each group, kLanes group .. kLanes group + kLanes - 1, the box around the
// centres and the largest radius, without the padding; these columns end with groups that are far away, to a
// multiple of kLanes too.
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

// Regions near a leaf of a tool: the gap between both surfaces, the way out of the region (unit; where the
// centres coincide the second axis), and the region's number. Room for all and 2 kLanes more.
struct NearRegions {
  double* gap;
  double* nx;
  double* ny;
  double* nz;
  std::uint32_t* number;
};

// Number of remaining regions in the columns, and the index of the deepest (smallest gap), or count if there
// is none.
struct RemainingRegions {
  std::size_t deepest, count;
};

// Added to a number below 2^51, it rounds it to a whole one and leaves that in the low bits.
inline constexpr double kRoundsToWhole = 0x1.8p52;
// Taken away before, it makes that rounding down; what is less than a hair below an integer counts as it.
inline constexpr double kAlmostHalf = 0.5 - 0x1p-34;

// What there is to know about surface disks in the tool frame; room for as many as were asked for, padded to
// kLanes.
struct DiskColumns {
  double* p_T[3];
  double* n_T[3];
  double* radius;
  double* distance;
  double* gradient_T[3];
  double* slope;        // of the field in the plane of the disk; NaN without a normal
  double* lower;        // bound of the distance of any place of the disk
  std::uint64_t* cell;  // cell_and_octant() of the place, for the way against the gradient
};

// Rounds a number below 2^39 to a multiple of 2^-12 when it is added and taken away.
inline constexpr double kRoundsToPatchGrid = 0x1.8p40;

// The axes of a patch of surface in the world, core/tracked_sheet, and its cylinder about n: radius and half
// height in units of unit_m.
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

// Heights at the corners of square cells over |u|, |v| <= half, those along u running fastest. last: what
// counts as the last place of the last cell.
struct HeightGrid {
  const double* corner;
  int cells;
  double half, per_unit, last;
};

// Of places no farther than reach from (u, v), the heights no farther than off from a plane.
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

struct Kernels {
  const char* isa;
  // Appends the points of the run with |x - centre|^2 <= (reach + r_f)^2, all in double; NaN never qualifies.
  // Returns the new count.
  std::size_t (*append_within)(const PointRun&, const double centre[3], double reach, const PointSink&,
                               std::size_t count);
  ContactQuery (*contact_query)(const PointsView&, const double p[3], const ProxyRegions&);
  // (4.9), (5.9): the smallest d > 0 at which a proxy that moves from p along the unit vector meets a point
  // ahead, |p + d direction - x| = reach + r_f; infinite when it meets none.
  double (*first_hit)(const PointsView&, const double p[3], const double direction[3], double reach);
  // (4.10), (5.11): the largest positive root over the points with r_n < inner; 0 without such points.
  double (*exit_distance)(const PointsView&, const double p[3], const double direction[3], double reach,
                          double inner);
  // Three standard normals for each of the points index[0..count).
  void (*normals)(const NoiseStream&, const std::uint32_t* index, std::size_t count, double* x, double* y,
                  double* z);
  // Of the points first .. first + count - 1, in order, those whose random words allow the x normal to be
  // what x[i] asks and the z normal what z asks (word_bounds in noise.h); of points that are not returned
  // neither is. Returns how many; index has room for count + kLanes.
  std::size_t (*candidates)(const NoiseStream&, std::uint32_t first, std::size_t count,
                            const std::uint64_t* x, std::uint64_t z, std::uint32_t* index);
  // Of the spheres of each group, kLanes group .. kLanes group + kLanes - 1: numbers of those that hold
  // places within reach of the tool, in order, and of some others that are near. Returns how many; found has
  // room for all.
  std::size_t (*near_spheres)(const SphereColumns&, const std::uint32_t* groups, std::size_t group_count,
                              const CellTransform&, const CellTable&, const NearnessCode&,
                              std::uint32_t* found);
  // Of the points of each group, kLanes group .. kLanes group + kLanes - 1: numbers of those that lie in a
  // cell whose value is least or more, in order; NaN lies in none. A point less than a cell outside the grid
  // counts as inside it. Returns how many; found has room for all.
  std::size_t (*points_in_cells)(const double* x, const double* y, const double* z,
                                 const std::uint32_t* groups, std::size_t group_count, const CellTransform&,
                                 const CellTable&, int min, std::uint32_t* found);
  // The disks around the points index[0..count), of radius share x spacing: bit for bit what sample_field()
  // and lower_bound_m() tell, but for places outside the grid, whose lower is NaN.
  void (*disks_in_field)(const PointColumns&, const std::uint32_t* index, std::size_t count, double fraction,
                         double cells_per_m, const PosedField&, const DiskColumns&);
  // Appends the spheres of a run with gaps of margin or less to a leaf, x, y, z and radius, 7.4.1. Returns
  // the new count. Gap: |leaf - sphere| - both radii, the leaf's first; NaN is no gap.
  std::size_t (*append_near_regions)(const SphereRun&, const double leaf[4], double margin,
                                     const NearRegions&, std::size_t count);
  // The first with the least gap; count where there is none. Writes infinity behind the last gap.
  std::size_t (*deepest_region)(const NearRegions&, std::size_t count);
  // Sorts out the one that is kept, those that it stands for - the cosine between both lines is alike or
  // more, and no motion of the leaf of this length or less that obeys the one kept violates them - and those
  // with gaps above most. They get infinite gaps, and once they are many the others close up, in the same
  // order; their numbers stay behind. After deepest_region().
  RemainingRegions (*next_deepest_region)(const NearRegions&, std::size_t count, std::size_t kept,
                                          double motion, double alike, double max);
  // The points that lie in a patch's cylinder, in order, their coordinates rounded to kRoundsToPatchGrid; NaN
  // lies in none. Returns how many; the columns have room for padded_count.
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
  // The points of one row in the camera frame, their z times scale.
  void (*depth_to_points)(const PixelRow&, double scale, const PointPlanes&);
  // (7.1), (7.2): what the filter adds to the z of every pixel, for points with lengths in units of
  // sigma_f / sqrt(kFilterExponent / 2).
  void (*filter_depth)(const RowBand&, const PointPlanes& points, float* change);
  // Unit normals towards the sensor, NaN where there is no plane. Lengths are in units of the radius; step is
  // (1 / fx, 1 / fy).
  void (*plane_normals)(const RowBand&, const PointPlanes& points, const PixelRays&, const float step[2],
                        const PointPlanes& normals);
  // One row into the cloud; X_WC row by row, three rows of four. z are those of the points the normals are
  // of.
  void (*points_to_cloud)(const PixelRow&, const double X_WC[12], const CloudRow&);
  void (*normals_to_cloud)(int width, const float* z, const PointPlanes& normals, const double X_WC[12],
                           const CloudRow&);
};

// x86-64 levels in rising order.
enum class Isa { x86_64, x86_64_v3, x86_64_v4 };

Isa best_isa();                   // of the running machine
const Kernels& kernels_for(Isa);  // pre: the machine has that level

}  // namespace remote_touch
