// Gaussian noise: Philox4x32-10 (Salmon et al. 2011) and Box-Muller, with own elementary functions, because
// those of the C library differ in the last bit between machines.
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

struct Words {
  std::uint32_t w[4];
};

inline Words philox(const NoiseStream& stream, std::uint32_t point) {
  std::uint32_t a = point, b = stream.counter[0], c = stream.counter[1], d = stream.counter[2];
  std::uint32_t key0 = stream.key[0], key1 = stream.key[1];
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t left = std::uint64_t{0xD2511F53u} * a, right = std::uint64_t{0xCD9E8D57u} * c;
    a = static_cast<std::uint32_t>(right >> 32) ^ b ^ key0;
    c = static_cast<std::uint32_t>(left >> 32) ^ d ^ key1;
    b = static_cast<std::uint32_t>(right), d = static_cast<std::uint32_t>(left);
    key0 += 0x9E3779B9u, key1 += 0xBB67AE85u;
  }
  return {{a, b, c, d}};
}

// ln u for u in (0, 1], to 1e-15 relative: u = m 2^e with m in [2/3, 4/3), ln m = 2 artanh((m - 1)/(m + 1)).
inline double logarithm(double u) {
  std::uint64_t bits = __builtin_bit_cast(std::uint64_t, u);
  const std::uint64_t shifted = bits - 0x3FE5555555555555u;  // exponent of u relative to 2/3
  const auto exponent = static_cast<std::int64_t>(shifted) >> 52;
  const double m = __builtin_bit_cast(double, bits - (static_cast<std::uint64_t>(exponent) << 52));
  const double s = (m - 1.0) / (m + 1.0), s2 = s * s;
  double series = 1.0 / 23.0;
  series = series * s2 + 1.0 / 21.0, series = series * s2 + 1.0 / 19.0, series = series * s2 + 1.0 / 17.0;
  series = series * s2 + 1.0 / 15.0, series = series * s2 + 1.0 / 13.0, series = series * s2 + 1.0 / 11.0;
  series = series * s2 + 1.0 / 9.0, series = series * s2 + 1.0 / 7.0, series = series * s2 + 1.0 / 5.0;
  series = series * s2 + 1.0 / 3.0, series = series * s2 + 1.0;
  return static_cast<double>(static_cast<std::int32_t>(exponent)) * 0.6931471805599453 + 2.0 * s * series;
}

// Radius and angle of one Box-Muller pair. u = (k + 1) 2^-32 lies in (0, 1], so the radius is at most
// sqrt(64 ln 2) = 6.6605: a hard bound that lets a scenario skip points that cannot come near.
inline double gaussian_radius(std::uint32_t k) {
  return __builtin_sqrt(-2.0 * logarithm((static_cast<double>(k) + 1.0) * 0x1p-32));
}

// Sine and cosine of 2 pi k / 2^32: the nearest quarter turn, then Taylor series on [-pi/4, pi/4].
inline void sine_cosine(std::uint32_t k, double* sine, double* cosine) {
  const std::uint32_t quarter = (k + 0x20000000u) >> 30;
  const auto rest = static_cast<std::int32_t>(k - (quarter << 30));
  const double a = static_cast<double>(rest) * (6.283185307179586 * 0x1p-32), a2 = a * a;
  double s = -1.0 / 1307674368000.0, c = -1.0 / 87178291200.0;
  s = s * a2 + 1.0 / 6227020800.0, s = s * a2 - 1.0 / 39916800.0, s = s * a2 + 1.0 / 362880.0;
  s = s * a2 - 1.0 / 5040.0, s = s * a2 + 1.0 / 120.0, s = s * a2 - 1.0 / 6.0, s = (s * a2 + 1.0) * a;
  c = c * a2 + 1.0 / 479001600.0, c = c * a2 - 1.0 / 3628800.0, c = c * a2 + 1.0 / 40320.0;
  c = c * a2 - 1.0 / 720.0, c = c * a2 + 1.0 / 24.0, c = c * a2 - 0.5, c = c * a2 + 1.0;
  const bool odd = quarter & 1u;
  const double first = odd ? c : s, second = odd ? s : c;
  *sine = (quarter & 2u) ? -first : first;
  *cosine = ((quarter + 1u) & 2u) ? -second : second;
}

}  // namespace

void normals(const NoiseStream& stream, const std::uint32_t* index, std::size_t count, double* x, double* y,
             double* z) {
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const Words words = philox(stream, index[i]);
    double sine, cosine, sine_unused, cosine_z;
    sine_cosine(words.w[1], &sine, &cosine);
    sine_cosine(words.w[3], &sine_unused, &cosine_z);
    const double radius = gaussian_radius(words.w[0]);
    x[i] = radius * cosine, y[i] = radius * sine;
    z[i] = gaussian_radius(words.w[2]) * cosine_z;
  }
}

std::size_t large_normals(const NoiseStream& stream, std::uint32_t first, std::size_t count,
                          const std::uint32_t* xy_limit, std::uint32_t z_limit, std::uint32_t* index) {
  constexpr std::size_t kChunk = 64;
  std::uint32_t large[kChunk];
  std::size_t found = 0;
  for (std::size_t done = 0; done < count; done += kChunk) {
    const std::size_t chunk = count - done < kChunk ? count - done : kChunk;
    const auto start = first + static_cast<std::uint32_t>(done);
#pragma omp simd
    for (std::size_t i = 0; i < chunk; ++i) {
      const Words words = philox(stream, start + static_cast<std::uint32_t>(i));
      large[i] = (words.w[0] <= xy_limit[done + i]) & (words.w[2] <= z_limit);
    }
    for (std::size_t i = 0; i < chunk; ++i) {
      index[found] = start + static_cast<std::uint32_t>(i);
      found += large[i];
    }
  }
  return found;
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
