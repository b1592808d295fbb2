// What lies near a tool, 6.2.2: groups of points, points, and the distance field at surface disks. Points and
// spheres come in whole groups: group g is kLanes g .. kLanes g + kLanes - 1 of columns padded to kLanes.
#pragma once

#include <cstdint>

#include "core/kernels/lanes.h"

namespace remote_touch {

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

// Centres and radii, m.
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

// Points with normals (NaN: none) and distances to the points around them, m.
struct PointColumns {
  const double* x;
  const double* y;
  const double* z;
  const double* nx;
  const double* ny;
  const double* nz;
  const double* spacing;
};

// Where a tool is, and its distance field in m at the nodes of a grid, the first coordinate running fastest;
// size is the edge of a cell.
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
// Taken away before, it makes that rounding down; what is less than a hair below an integer counts as it.
inline constexpr double kAlmostHalf = 0.5 - 0x1p-34;

// What there is to know about surface disks in the tool frame; capacity for as many as were asked for, padded
// to kLanes. Lengths in m.
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

struct ToolKernels {
  // Of the spheres of the groups: numbers of those that hold places within reach of the tool, in order, and
  // of some others that are near. Returns how many; found has the capacity for all.
  std::size_t (*near_spheres)(const SphereColumns&, const std::uint32_t* groups, std::size_t group_count,
                              const CellTransform&, const CellTable&, const NearnessCode&,
                              std::uint32_t* found);
  // Of the points of the groups: numbers of those that lie in a cell whose value is min or more, in order;
  // NaN lies in none. A point less than a cell outside the grid counts as inside it. Returns how many; found
  // has the capacity for all.
  std::size_t (*points_in_cells)(const double* x, const double* y, const double* z,
                                 const std::uint32_t* groups, std::size_t group_count, const CellTransform&,
                                 const CellTable&, int min, std::uint32_t* found);
  // The disks around the points index[0..count), of radius fraction x spacing: bit for bit what
  // sample_field() and lower_bound_m() give, but for places outside the grid, whose lower is NaN.
  void (*disks_in_field)(const PointColumns&, const std::uint32_t* index, std::size_t count, double fraction,
                         double cells_per_m, const PosedField&, const DiskColumns&);
};

}  // namespace remote_touch
