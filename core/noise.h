// Gaussian noise from a counter-based generator: the value belongs to (seed, cell, replicate, frame, point),
// so any point of any frame of any sweep cell can be made alone, in any order, by any thread, with the same
// bits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/kernels.h"

namespace remote_touch {

// What a run is keyed by; cell and replicate are those of a sweep and 0 outside one.
struct NoiseKey {
  std::uint64_t seed = 1;
  std::uint64_t cell = 0;       // below 2^32
  std::uint64_t replicate = 0;  // below 2^32
};

// Independent uses of one key.
enum class NoiseUse : std::uint32_t { point_position = 0, depth = 1 };

// No standard normal made here is larger in magnitude: sqrt(64 ln 2), rounded up.
inline constexpr double kLargestNormal = 6.661;

// pre: frame < 2^28.
inline NoiseStream noise_stream(const NoiseKey& key, NoiseUse use, std::uint32_t frame) {
  return {{static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)},
          {frame | static_cast<std::uint32_t>(use) << 28, static_cast<std::uint32_t>(key.cell),
           static_cast<std::uint32_t>(key.replicate)}};
}

// The radius of a pair of normals falls with the random word it is made of, so a word above this limit makes
// a radius below the one given. The limit is generous by a millionth: no word at or above the radius is
// missed, whatever the last bit of the C library's exp.
std::uint32_t largest_word(double radius);

}  // namespace remote_touch
