// Detection between a leaf of a tool's sphere tree and forbidden regions, 7.4.1, and selection of the pairs
// that become constraints, 7.4.2. Lengths in m.
#pragma once

#include <cstdint>

#include "core/kernels/lanes.h"

namespace remote_touch {

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

}  // namespace remote_touch
