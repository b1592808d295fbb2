// A leaf of a tool's sphere tree against forbidden regions, 7.4.1, and which of the pairs become constraints,
// 7.4.2. Lengths in m.
#pragma once

#include <cstdint>

#include "core/kernels/lanes.h"

namespace remote_touch {

// Spheres numbered first, first + 1, ...; padded with far-away ones of radius 0 to a multiple of kLanes. low,
// high and max_radius: for each group of kLanes spheres the box around the centres and the largest radius,
// without the padding; these columns are padded with far-away groups to a multiple of kLanes too.
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

// Regions near a leaf of a tool: the gap between both surfaces, negative where they overlap; the unit normal
// out of the region, world frame (+y where the centres coincide); the region's number. Capacity for all and 2
// kLanes more.
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

struct RegionKernels {
  // Appends the spheres of a run whose gap to a leaf (x, y, z, radius) is margin or less, 7.4.1. Returns the
  // new count. Gap: |leaf - sphere| less both radii, the leaf's first; a NaN gap is never appended.
  std::size_t (*append_near_regions)(const SphereRun&, const double leaf[4], double margin,
                                     const NearRegions&, std::size_t count);
  // The first with the smallest gap; count where there is none. Writes infinity behind the last gap.
  std::size_t (*deepest_region)(const NearRegions&, std::size_t count);
  // Removes region `kept`, those that it makes redundant - the cosine between both normals is alike or more,
  // and no motion of the leaf up to the length motion that obeys `kept` violates them - and those with gaps
  // above max. They get infinite gaps; once they are many the remaining ones move together, in the same
  // order. After deepest_region().
  RemainingRegions (*next_deepest_region)(const NearRegions&, std::size_t count, std::size_t kept,
                                          double motion, double alike, double max);
};

}  // namespace remote_touch
