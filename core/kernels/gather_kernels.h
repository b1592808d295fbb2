// Copies the points in a ball from the runs that a neighbour search visits, 4.2.2 and 5.2. Lengths in m.
#pragma once

#include <cstdint>

#include "core/kernels/lanes.h"

namespace remote_touch {

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

}  // namespace remote_touch
