// Detection of spheres and points near a tool, 6.2.2, and the distance field at surface disks. Points and
// spheres are processed in whole groups: group g is kLanes g .. kLanes g + kLanes - 1 of columns that are
// padded to kLanes.
#pragma once

#include <cstdint>

#include "core/kernels/kernels.h"

namespace remote_touch {

// One byte for each cell of a regular grid; the first coordinate runs fastest. Three more bytes after the
// last one must be readable.
struct CellTable {
  const std::int8_t* value;
  int cells[3];
};

// Transforms world coordinates, m, to cell coordinates: along each axis, row[0..2] . (x, y, z) + row[3].
struct CellTransform {
  double row[3][4];
};

// Centres and radii, m.
struct SphereColumns {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
};

// Slabs around groups of points: all points are within `radius` of the centre, and within `half` of the
// plane through it with this unit normal (zero: `half` is zero too). Lengths in m.
struct SlabColumns {
  SphereColumns sphere;
  const double* nx;
  const double* ny;
  const double* nz;
  const double* half;
  const double* facing[3];  // mean of the normals of the points, apart from points without one
  const double* deviation;  // largest length of the difference of a normal from it
};

// The range of the slope of a field in blocks of 2^shift cells along each side, and in `around` cells on each
// side of them. Per block: the least and the largest change per cell along x, then y, then z, m.
struct SlopeTable {
  const float* range;
  int blocks[3];
  int shift, around;
};

// Interprets a table as distances: no position of a cell is nearer to the tool than (zero - value) * unit
// cells. reach: distance to search, cells; per_m: cells per metre, for radii.
struct NearnessCode {
  double zero, unit;
  double reach, per_m;
};

// Points in m with normals (NaN: none). spacing: distance to the points around.
struct PointColumns {
  const double* x;
  const double* y;
  const double* z;
  const double* nx;
  const double* ny;
  const double* nz;
  const double* spacing;
  const double* extent;  // radius of the area that the point represents; 0 if only itself
};

// Limits that select disks of points, m.
struct DiskLimits {
  double reach;   // largest distance of their centres
  double lower;   // largest lower bound of their distances
  double search;  // limit for DiskColumns::bound
  double passed;  // groups of points that were farther away than this before are skipped
};

// The pose of a tool, and its distance field in m at the nodes of a grid; the first coordinate runs fastest.
// size is the edge of a cell, m.
struct PosedField {
  double R_TW[3][3];
  double p_W[3];
  const float* node;
  int cells[3];
  double origin_T[3];
  double size;
};

// Limits that select slabs, m.
struct SlabLimits {
  double reach;  // largest distance
  double slope;  // largest length of the field's gradient at distances up to `trusted`
  double trusted;
};

// The motion of ClearWay::Motion, as the motion of points in the tool frame from p to turned (p - a). m, rad.
struct SlabWay {
  double turned[3][3];
  double a_T[3];
  double shift, turn;
  double slope;       // largest length of the field's gradient
  double far;         // points with a larger distance before the motion do not matter
  double touch;       // distance that points have to keep
  double ahead_W[3];  // points do not matter if their normals have a positive product with it; or zero
};

// When this constant is added to a number below 2^51, the number is rounded to a whole one, which is then in
// the low bits.
inline constexpr double kRoundsToWhole = 0x1.8p52;
// When this constant is subtracted first, that rounding becomes rounding down. A number that is less than
// 2^-34 below an integer counts as that integer.
inline constexpr double kAlmostHalf = 0.5 - 0x1p-34;

// Surface disks in the tool frame. Each column has capacity for kLanes more than there are points. Lengths in
// m.
struct DiskColumns {
  double* p_T[3];
  double* n_T[3];
  double* radius;
  double* distance;
  double* gradient_T[3];
  double* slope;   // slope of the field in the plane of the disk; NaN without a normal
  double* lower;   // lower bound of the distance of any position on the disk
  double* bound;   // distance if lower <= `search` and the field is flat over the disk; else lower
  double* cell;    // bits of cell_and_octant() of p_T and the direction against the gradient
  double* extent;  // PointColumns::extent of its point
};

// Limits that select points, m.
struct PointLimits {
  double reach;   // largest distance
  double passed;  // the same as in DiskLimits
};

// Points in the tool frame. Each column has capacity for kLanes more than there are points. Lengths in m.
struct PositionColumns {
  double* p_T[3];
  double* distance;  // NaN outside the grid
  double* number;    // index of the point, a whole number
};

// A constraint (6.3) with the members of ToolContact; m.
struct ContactNumbers {
  double r_T[3], n_T[3];
  double depth, side;
};

// Limits that define contact of points with a tool, m.
struct TouchLimits {
  double reach;   // points farther away are ignored
  double voxels;  // points farther away are in no voxel of the tool
  double touch;   // largest distance of a disk that is touched
  double slope;   // largest length of the field's gradient at distances up to `reach`
  double passed;  // the same as in DiskLimits
};

// The touched points of a cloud. The lists have capacity for kLanes more than there are points.
struct TouchedSummary {
  double nearest;           // distance of the nearest point in the grid, m; infinite if none is within reach
  std::size_t point_count;  // number of touched points
  bool is_inside;           // true if a point is in an interior voxel
  std::uint64_t* cluster;   // cell_number() of the touched points; each value at least once
  std::size_t clusters;     // length of that list
  std::uint32_t* unclear;   // points that this query cannot decide
  std::size_t unclear_count;
};

// The disk of a point has the radius fraction x spacing + extent. Its cell is one of a grid with so many
// cells.
struct DiskShape {
  double fraction, cells_per_m;
};

// The smallest distance of each group of kLanes points, or a lower bound of it. It is written if is_new; else
// it is read, and groups that are farther away than `passed` of the limits are skipped.
struct GroupDistances {
  double* nearest;
  bool is_new;
};

// The slabs number[index[0..count)]. The points of slab number[i] are at least nearest[i] - change away.
struct ChosenSlabs {
  const std::uint32_t *number, *index;
  std::size_t count;
  const double* nearest;
  double change;
};

struct ToolKernels {
  // Finds the spheres of the groups that contain positions within reach of the tool, in order, and some
  // others that are near. Writes their indices into found, which has capacity for all. Returns their number.
  std::size_t (*near_spheres)(const SphereColumns&, const std::uint32_t* groups, std::size_t group_count,
                              const CellTransform&, const CellTable&, const NearnessCode&,
                              std::uint32_t* found);
  // Finds the slabs of the groups that contain positions within reach of the tool, in order, and some others.
  // Writes their indices into found and lower bounds of the distances of their positions into nearest; both
  // have capacity for all. Returns their number.
  std::size_t (*slabs_in_field)(const SlabColumns&, const std::uint32_t* groups, std::size_t group_count,
                                const PosedField&, const SlopeTable&, const SlabLimits&, std::uint32_t* found,
                                double* nearest);
  // Finds those of the chosen slabs whose points can come nearer than way.touch during a motion, in order,
  // and some others; fewer others if it is cut in more parts. Writes their indices i into found, which has
  // capacity for all, and may be chosen.index. Returns their number.
  std::size_t (*slabs_on_way)(const SlabColumns&, ChosenSlabs chosen, const PosedField&, const SlopeTable&,
                              const SlabWay&, int parts, std::uint32_t* found);
  // Finds the points of the groups that lie in a cell whose value is min or more, in order. A NaN point is in
  // no cell. A point less than a cell below the grid counts as inside it. Writes their indices into found,
  // which has capacity for all. Returns their number.
  std::size_t (*points_in_cells)(const double* x, const double* y, const double* z,
                                 const std::uint32_t* groups, std::size_t group_count, const CellTransform&,
                                 const CellTable&, int min, std::uint32_t* found);
  // Computes the disks around the first count points that are within the limits, in the order of the points.
  // The values are those of sample_field() and lower_bound_m(), bit for bit. All points outside the grid are
  // included, with NaN as lower. The columns of the points are padded. Returns the number of disks;
  // outside_count is the number of those outside the grid.
  std::size_t (*disks_in_field)(const PointColumns&, std::size_t count, DiskShape, const PosedField&,
                                const DiskLimits&, GroupDistances, const DiskColumns&,
                                std::size_t& outside_count);
  // Computes the points of the groups that are within the limits, in the order of the points, with the values
  // of sample_field(), bit for bit. A point outside the grid is included if the nearest position of the grid
  // is within reach. Groups are skipped by their distances also if these are new. Returns the number of
  // points; outside_count is the number of those outside the grid.
  std::size_t (*points_in_field)(const PointColumns&, const std::uint32_t* groups, std::size_t group_count,
                                 const PosedField&, const PointLimits&, GroupDistances,
                                 const PositionColumns&, std::size_t& outside_count);
  // Finds the touched points of the groups. A point is touched if it lies in a voxel (1: shell, 2: interior),
  // or if the distance of its centre is at most limits.touch. A point is unclear if it lies outside the grid,
  // or if its disk may be as near as limits.touch and only a search can show it. Groups are skipped as by
  // points_in_field(). The cells of the disks are the clusters.
  void (*touched_points)(const PointColumns&, const std::uint32_t* groups, std::size_t group_count, DiskShape,
                         const PosedField&, const CellTable& voxels, const TouchLimits&, GroupDistances,
                         TouchedSummary&);
  // Computes the contacts of the disks number[0..count), bit for bit: those of far_contact() if lower >
  // search, else those of near_contact() at nearest_position(). depth is NaN if the search leaves the grid.
  void (*disk_contacts)(const DiskColumns&, const std::uint32_t* number, std::size_t count, const PosedField&,
                        double search, double known_side, ContactNumbers* contacts);
};

}  // namespace remote_touch

// Constants of the search for the nearest position on a disk, and of the contact computed from it. They are
// shared by near_points.h, near_points.cpp and the kernels that process many disks at once.
namespace remote_touch::disk_search {

inline constexpr int kLines = 2;            // lines to search: one for an edge of the tool, two for a corner
inline constexpr int kCuts = 4;             // cuts of a line
inline constexpr double kFlatSlope = 0.05;  // largest slope of the field in which a disk counts as flat
inline constexpr double kFlatDepth_m = 1e-5;  // largest rise of the field over a flat disk of merged points
inline constexpr double kEdgeOnSine =
    0.2;                                 // largest sine of the angle between an edge-on disk and the gradient
inline constexpr double kStep_m = 2e-4;  // step off the plane of a disk, to see where the tool continues
inline constexpr double kMinGradient = 0.5;  // a shorter gradient deep in the tool shows no side: a ridge

}  // namespace remote_touch::disk_search
