#include "core/points/noise.h"

#include <algorithm>
#include <cmath>

#include "core/kernels/philox.h"

namespace remote_touch {

namespace {
struct Product {
  static std::uint64_t of(std::uint64_t a, std::uint64_t b) { return (a & kWord) * (b & kWord); }
};
}  // namespace

std::array<double, 4> uniforms(const NoiseStream& stream, std::uint32_t point) {
  const auto words = Philox<std::uint64_t, Product>(stream)(point);
  std::array<double, 4> numbers;
  for (int i = 0; i < 4; ++i) numbers[i] = (static_cast<double>(words.w[i]) + 0.5) * 0x1p-32;
  return numbers;
}

// The normal is at most the radius in magnitude, radius^2 = -2 ln((word + 1) 2^-32), see kernels/noise.cpp.
std::uint64_t word_bounds(double min, double towards) {
  constexpr double kWords = 4294967296.0;
  if (!(min > 0)) return 0xFFFFFFFFu;
  const double words = kWords * std::exp(-0.5 * min * min) * (1 + 1e-6) + 1;
  const std::uint64_t sign = towards < 0 ? 1 : 0;
  return static_cast<std::uint64_t>(std::min(words, kWords - 1)) | sign << 62 | std::uint64_t{1} << 63;
}

}  // namespace remote_touch
