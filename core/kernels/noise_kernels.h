// Standard normals of the counter-based generator; core/numeric/noise.h defines its keys.
#pragma once

#include <cstddef>
#include <cstdint>

namespace remote_touch {

// Counter and key of the generator.
struct NoiseStream {
  std::uint32_t key[2];
  std::uint32_t counter[3];  // the generator's counter without its first word, which is the point's index
};

struct NoiseKernels {
  // Computes three standard normals for each of the points index[0..count), by the method of Box and Muller.
  void (*normals)(const NoiseStream&, const std::uint32_t* index, std::size_t count, double* x, double* y,
                  double* z);
  // Selects the points whose random words allow the x normal to meet the bound x[i] and the z normal to meet
  // the bound z (word_bounds() in noise.h). The points tested are first .. first + count - 1, in order. A
  // point that is not selected misses at least one of the bounds. Returns the number of selected points;
  // index has capacity for count + kLanes.
  std::size_t (*candidates)(const NoiseStream&, std::uint32_t first, std::size_t count,
                            const std::uint64_t* x, std::uint64_t z, std::uint32_t* index);
};

}  // namespace remote_touch
