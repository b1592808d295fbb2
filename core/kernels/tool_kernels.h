// Which spheres and points lie near a tool, 6.2.2, and the distance field at surface disks. Points and
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

// From world coordinates, m, to cell coordinates: along each axis row[0..2] . (x, y, z) + row[3].
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

// Reads a table as distances: no place of a cell is nearer to the tool than (zero - value) * unit cells.
// reach: distance to search, cells; per_m: cells per metre, for radii.
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
  const double* extent;  // of what a point stands for around it; 0 for itself alone
};

// Which disks of points are wanted, m.
struct DiskLimits {
  double reach;   // their centres are no farther than this,
  double lower;   // and their lower bounds no higher
  double search;  // for DiskColumns::bound
  double passed;  // no disk is wanted of groups of points that were farther away than this before
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
// Subtracted first, it makes that rounding down; a number less than 2^-34 below an integer counts as that
// integer.
inline constexpr double kAlmostHalf = 0.5 - 0x1p-34;

// Surface disks in the tool frame; capacity for kLanes more than there are points. Lengths in m.
struct DiskColumns {
  double* p_T[3];
  double* n_T[3];
  double* radius;
  double* distance;
  double* gradient_T[3];
  double* slope;  // of the field in the plane of the disk; NaN without a normal
  double* lower;  // bound of the distance of any place of the disk
  double* bound;  // distance where lower is no more than `search` and the disk is flat in the field; or lower
  double* cell;   // the bits of cell_and_octant() of p_T and the direction against the gradient
  double* extent;  // that of its point
};

// Which points are wanted, m.
struct PlaceLimits {
  double reach;   // they are no farther than this
  double passed;  // as in DiskLimits
};

// Points in the tool frame; capacity for kLanes more than there are points. Lengths in m.
struct PlaceColumns {
  double* p_T[3];
  double* distance;  // NaN outside the grid
  double* number;    // of the point, a whole number
};

// A constraint (6.3), as ToolContact has it; m.
struct ContactNumbers {
  double r_T[3], n_T[3];
  double depth, side;
};

// What counts as touched, m.
struct TouchLimits {
  double reach;   // points farther away do not count at all
  double voxels;  // points farther away are in no voxel of the tool
  double touch;   // largest distance of a disk that is touched
  double slope;   // no gradient of the field is longer, where that is `reach` or less
  double passed;  // as in DiskLimits
};

// What of a cloud is touched. The lists have capacity for kLanes more than there are points.
struct TouchedSummary {
  double nearest;          // distance of a point, m; infinite if none is within reach
  std::size_t points;      // that are touched
  bool is_inside;          // one of them is in an interior voxel
  std::uint64_t* cluster;  // cell_number() of all of them, each at least once
  std::size_t clusters;    // length of that list
  std::uint32_t* unclear;  // points that this does not tell of
  std::size_t unclear_count;
};

struct ToolKernels {
  // Of the spheres of the groups: numbers of those that contain places within reach of the tool, in order,
  // and of some others that are near. Returns how many; found has the capacity for all.
  std::size_t (*near_spheres)(const SphereColumns&, const std::uint32_t* groups, std::size_t group_count,
                              const CellTransform&, const CellTable&, const NearnessCode&,
                              std::uint32_t* found);
  // Of the points of the groups: numbers of those that lie in a cell whose value is min or more, in order;
  // NaN lies in none. A point less than a cell outside the grid counts as inside it. Returns how many; found
  // has the capacity for all.
  std::size_t (*points_in_cells)(const double* x, const double* y, const double* z,
                                 const std::uint32_t* groups, std::size_t group_count, const CellTransform&,
                                 const CellTable&, int min, std::uint32_t* found);
  // The disks around the first count points, of radius fraction x spacing + extent, those alone that the
  // limits want, in the order of the points: bit for bit what sample_field() and lower_bound_m() give. Places
  // outside the grid are all taken, with NaN as lower. nearest: of each group of kLanes points the least
  // distance, or less; it is written if is_new, else read and compared with limits.passed. The columns of the
  // points are padded. Returns how many disks there are, outside_count of them outside the grid.
  std::size_t (*disks_in_field)(const PointColumns&, std::size_t count, double fraction, double cells_per_m,
                                const PosedField&, const DiskLimits&, double* nearest, bool is_new,
                                const DiskColumns&, std::size_t& outside_count);
  // The points of the groups that the limits want, in their order: bit for bit what sample_field() gives. A
  // point outside the grid is taken if the nearest place of the grid is within reach. nearest and is_new are
  // as above, one for each group[i]. Returns how many there are, outside_count of them outside the grid.
  std::size_t (*points_in_field)(const PointColumns&, const std::uint32_t* groups, std::size_t group_count,
                                 const PosedField&, const PlaceLimits&, double* nearest, bool is_new,
                                 const PlaceColumns&, std::size_t& outside_count);
  // Of the points of the groups: those in a voxel (1: shell, 2: interior), and those whose disks of radius
  // fraction x spacing have their centres as near as limits.touch. Unclear are disks that only a search could
  // show to be so near, and places outside the grid. nearest and is_new are as above, one for each group[i].
  void (*touched_points)(const PointColumns&, const std::uint32_t* groups, std::size_t group_count,
                         double fraction, double clusters_per_m, const PosedField&, const CellTable& voxels,
                         const TouchLimits&, double* nearest, bool is_new, TouchedSummary&);
  // The contacts of the disks number[0..count): bit for bit those of far_contact() if lower is more than
  // search, else those of near_contact() at nearest_place(); depth is NaN if that leaves the grid.
  void (*disk_contacts)(const DiskColumns&, const std::uint32_t* number, std::size_t count, const PosedField&,
                        double search, double known_side, ContactNumbers* contacts);
};

}  // namespace remote_touch
