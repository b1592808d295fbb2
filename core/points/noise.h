// Gaussian noise from a counter-based generator: the value belongs to (seed, cell, replicate, frame, point),
// so any point of any frame of any sweep cell can be computed alone, in any order, by any thread, with the
// same bits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/kernels/point_kernels.h"

namespace remote_touch {

// Key of the noise of a run; cell and replicate are those of a sweep and 0 outside one.
struct NoiseKey {
  std::uint64_t seed = 1;
  std::uint64_t cell = 0;       // below 2^32
  std::uint64_t replicate = 0;  // below 2^32
};

// Independent uses of one key.
enum class NoiseUse : std::uint32_t {
  point_position = 0,
  depth = 1,
  transport = 2,
  motion = 3,
  colour = 4,
  dropout = 5,
  sensor_point = 6,
  sensor_frame = 7,
  sensor_ray = 8,
  command_channel = 9,
  force_channel = 10,
  registration = 11,
};

// The upper bound of the magnitude of every standard normal of this generator: sqrt(64 ln 2), rounded up.
inline constexpr double kMaxNormal = 6.661;

// pre: frame < 2^28.
inline NoiseStream noise_stream(const NoiseKey& key, NoiseUse use, std::uint32_t frame) {
  return {{static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)},
          {frame | static_cast<std::uint32_t>(use) << 28, static_cast<std::uint32_t>(key.cell),
           static_cast<std::uint32_t>(key.replicate)}};
}

// Returns the random words of one point of the stream, as numbers uniform in (0, 1). The normals of the same
// point are computed from the same words.
std::array<double, 4> uniforms(const NoiseStream& stream, std::uint32_t point);

// Converts a condition on a normal to a necessary condition on the two random words from which it is
// computed. The condition is normal >= min, or normal <= -min if towards < 0; there is none if min <= 0. The
// magnitude of the normal is at most a radius that decreases with the first word, and its sign follows from
// the second. The result is too permissive by a millionth and never too strict, so it does not depend on the
// last bit of the C library's exp. Bits 0 to 31: largest first word; 62: the required sign, 1 for negative;
// 63: a sign is required.
std::uint64_t word_bounds(double min, double towards);

}  // namespace remote_touch
