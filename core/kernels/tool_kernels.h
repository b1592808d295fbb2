// Detection of spheres and points near a tool, 6.2.2, and the distance field at surface disks. Points and
// spheres come in whole groups: group g is kLanes g .. kLanes g + kLanes - 1 of columns padded to kLanes.
#pragma once

#include <cstdint>

#include "core/kernels/lanes.h"

namespace remote_touch {

// One byte for each cell of a regular grid, the first coordinate running fastest; three more bytes after the
// last must be readable.
struct CellTable {
  const std::int8_t* value;
  int cells[3];
};

// Transforms world coordinates, m, to cell coordinates: along each axis row[0..2] . (x, y, z) + row[3].
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

// Interprets a table as distances: no position of a cell is nearer to the tool than (zero - value) * unit
// cells. reach: distance to search, cells; per_m: cells per metre, for radii.
struct NearnessCode {
  double zero, unit;
  double reach, per_m;
};

// Points with normals (NaN: none) and distances to the points around them, m.
struct PointColumns {
  const double* x;
  const double* y;
  const double* z;
  const double* nx;
  const double* ny;
  const double* nz;
  const double* spacing;
  const double* extent;  // radius that the point stands for around itself; 0 for itself alone
};

// Limits that select disks of points, m.
struct DiskLimits {
  double reach;   // largest distance of their centres
  double lower;   // largest lower bound of their distances
  double search;  // limit for DiskColumns::bound
  double passed;  // groups of points that were farther away than this before are skipped
};

// The pose of a tool, and its distance field in m at the nodes of a grid, the first coordinate running
// fastest; size is the edge of a cell, m.
struct PosedField {
  double R_TW[3][3];
  double p_W[3];
  const float* node;
  int cells[3];
  double origin_T[3];
  double size;
};

// Added to a number below 2^51, it rounds it to a whole one and leaves that in the low bits.
inline constexpr double kRoundsToWhole = 0x1.8p52;
// Subtracted first, it makes that rounding down. A number less than 2^-34 below an integer counts as that
// integer.
inline constexpr double kAlmostHalf = 0.5 - 0x1p-34;

// Surface disks in the tool frame; capacity for kLanes more than there are points. Lengths in m.
struct DiskColumns {
  double* p_T[3];
  double* n_T[3];
  double* radius;
  double* distance;
  double* gradient_T[3];
  double* slope;   // slope of the field in the plane of the disk; NaN without a normal
  double* lower;   // lower bound of the distance of any position on the disk
  double* bound;   // distance if lower is no more than `search` and the disk is flat in the field; else lower
  double* cell;    // the bits of cell_and_octant() of p_T and the direction against the gradient
  double* extent;  // extent of its point
};

// Limits that select points, m.
struct PlaceLimits {
  double reach;   // largest distance
  double passed;  // the same as in DiskLimits
};

// Points in the tool frame; capacity for kLanes more than there are points. Lengths in m.
struct PlaceColumns {
  double* p_T[3];
  double* distance;  // NaN outside the grid
  double* number;    // number of the point, a whole number
};

// A constraint (6.3), as ToolContact has it; m.
struct ContactNumbers {
  double r_T[3], n_T[3];
  double depth, side;
};

// Limits that define contact of points with a tool, m.
struct TouchLimits {
  double reach;   // points farther away do not count at all
  double voxels;  // points farther away are in no voxel of the tool
  double touch;   // largest distance of a disk that is touched
  double slope;   // largest length of the field's gradient where the field is `reach` or less
  double passed;  // the same as in DiskLimits
};

// The touched points of a cloud. The lists have capacity for kLanes more than there are points.
struct TouchedSummary {
  double nearest;           // distance of a point, m; infinite if none is within reach
  std::size_t point_count;  // number of touched points
  bool is_inside;           // one of them is in an interior voxel
  std::uint64_t* cluster;   // cell_number() of all of them, each at least once
  std::size_t clusters;     // length of that list
  std::uint32_t* unclear;   // points that this query cannot decide
  std::size_t unclear_count;
};

struct ToolKernels {
  // Finds the spheres of the groups that contain positions within reach of the tool, in order, and some
  // others that are near. Writes their numbers into found, which has the capacity for all. Returns how many.
  std::size_t (*near_spheres)(const SphereColumns&, const std::uint32_t* groups, std::size_t group_count,
                              const CellTransform&, const CellTable&, const NearnessCode&,
                              std::uint32_t* found);
  // Finds the points of the groups that lie in a cell whose value is min or more, in order. NaN lies in no
  // cell. A point less than a cell outside the grid counts as inside it. Writes their numbers into found,
  // which has the capacity for all. Returns how many.
  std::size_t (*points_in_cells)(const double* x, const double* y, const double* z,
                                 const std::uint32_t* groups, std::size_t group_count, const CellTransform&,
                                 const CellTable&, int min, std::uint32_t* found);
  // Computes the disks around the first count points, of radius fraction x spacing + extent, that are within
  // the limits, in the order of the points. The values are those of sample_field() and lower_bound_m(), bit
  // for bit. All positions outside the grid are included, with NaN as lower. nearest: the least distance of
  // each group of kLanes points, or a lower one. It is written if is_new; else it is read and compared with
  // limits.passed. The columns of the points are padded. Returns the number of disks; outside_count of them
  // are outside the grid.
  std::size_t (*disks_in_field)(const PointColumns&, std::size_t count, double fraction, double cells_per_m,
                                const PosedField&, const DiskLimits&, double* nearest, bool is_new,
                                const DiskColumns&, std::size_t& outside_count);
  // Computes the points of the groups that are within the limits, in their order, with the values of
  // sample_field(), bit for bit. A point outside the grid is included if the nearest position of the grid is
  // within reach. nearest and is_new are as above, one for each group[i]. Returns the number of points;
  // outside_count of them are outside the grid.
  std::size_t (*points_in_field)(const PointColumns&, const std::uint32_t* groups, std::size_t group_count,
                                 const PosedField&, const PlaceLimits&, double* nearest, bool is_new,
                                 const PlaceColumns&, std::size_t& outside_count);
  // Finds the touched points of the groups. A point is touched if it lies in a voxel (1: shell, 2: interior),
  // or if the centre of its disk of radius fraction x spacing + extent is as near as limits.touch. A point is
  // unclear if only a search could show that its disk is so near, or if it lies outside the grid. nearest and
  // is_new are as above, one for each group[i].
  void (*touched_points)(const PointColumns&, const std::uint32_t* groups, std::size_t group_count,
                         double fraction, double clusters_per_m, const PosedField&, const CellTable& voxels,
                         const TouchLimits&, double* nearest, bool is_new, TouchedSummary&);
  // Computes the contacts of the disks number[0..count), bit for bit: those of far_contact() if lower is more
  // than search, else those of near_contact() at nearest_place(). depth is NaN if that search leaves the
  // grid.
  void (*disk_contacts)(const DiskColumns&, const std::uint32_t* number, std::size_t count, const PosedField&,
                        double search, double known_side, ContactNumbers* contacts);
};

}  // namespace remote_touch
