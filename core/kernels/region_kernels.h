// A leaf of a tool's sphere tree against forbidden regions, 7.4.1, and which of the pairs matter, 7.4.2.
// Lengths in m.
#pragma once

#include <cstdint>

#include "core/kernels/lanes.h"

namespace remote_touch {

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
// centres coincide the second axis), and the region's number. Capacity for all and 2 kLanes more.
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
  // Appends the spheres of a run with gaps of margin or less to a leaf, x, y, z and radius, 7.4.1. Returns
  // the new count. Gap: |leaf - sphere| - both radii, the leaf's first; NaN is no gap.
  std::size_t (*append_near_regions)(const SphereRun&, const double leaf[4], double margin,
                                     const NearRegions&, std::size_t count);
  // The first with the smallest gap; count where there is none. Writes infinity behind the last gap.
  std::size_t (*deepest_region)(const NearRegions&, std::size_t count);
  // Sorts out the one that is kept, those that it stands for - the cosine between both lines is alike or
  // more, and no motion of the leaf of this length or less that obeys the one kept violates them - and those
  // with gaps above most. They get infinite gaps, and once they are many the others close up, in the same
  // order; their numbers stay behind. After deepest_region().
  RemainingRegions (*next_deepest_region)(const NearRegions&, std::size_t count, std::size_t kept,
                                          double motion, double alike, double max);
};

}  // namespace remote_touch
