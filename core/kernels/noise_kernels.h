// Standard normals of the counter-based generator; core/points/noise.h defines its keys.
#pragma once

#include <cstddef>
#include <cstdint>

namespace remote_touch {

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

}  // namespace remote_touch
