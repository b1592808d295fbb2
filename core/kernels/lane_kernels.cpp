// Compiled once for each x86-64 level, with REMOTE_TOUCH_KERNELS naming the exported table. It includes
// nothing with inline functions that other files share: the linker could keep this level's copy for all of
// them.
#include "core/kernels.h"

#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace remote_touch {
namespace {

inline double larger(double a, double b) {
  return a > b ? a : b;
}
inline double smaller(double a, double b) {
  return a < b ? a : b;
}

// (4.2) with t = (r - r1) / (r3 - r1) clamped to [0, 1]; the clamp gives the three cases of the definition.
inline double wendland(double t) {
  const double q = 1.0 - t;
  return (q * q) * (q * q) * (4.0 * t + 1.0);
}

#ifdef __AVX512F__

// Compares eight points at once and stores the survivors side by side. The comparison is the scalar one, so
// the set is the same on every level. Whole vectors are stored: the sink has kLanes spare places.
std::size_t append_within(const PointRun& run, const double centre[3], double radius_squared,
                          const PointSink& sink, std::size_t n) {
  const __m512d cx = _mm512_set1_pd(centre[0]), cy = _mm512_set1_pd(centre[1]),
                cz = _mm512_set1_pd(centre[2]);
  const __m512d limit = _mm512_set1_pd(radius_squared);
  const __m256i ramp = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (std::size_t i = 0; i < run.count; i += kLanes) {
    const std::size_t left = run.count - i;
    const __mmask8 live = left >= kLanes ? 0xff : static_cast<__mmask8>((1u << left) - 1);
    const __m512d x = _mm512_maskz_loadu_pd(live, run.x + i);
    const __m512d y = _mm512_maskz_loadu_pd(live, run.y + i);
    const __m512d z = _mm512_maskz_loadu_pd(live, run.z + i);
    const __m512d dx = _mm512_sub_pd(x, cx), dy = _mm512_sub_pd(y, cy), dz = _mm512_sub_pd(z, cz);
    const __m512d d2 =
        _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy)), _mm512_mul_pd(dz, dz));
    const __mmask8 in = _mm512_mask_cmp_pd_mask(live, d2, limit, _CMP_LE_OQ);
    if (in == 0) continue;
    _mm512_storeu_pd(sink.x + n, _mm512_maskz_compress_pd(in, x));
    _mm512_storeu_pd(sink.y + n, _mm512_maskz_compress_pd(in, y));
    _mm512_storeu_pd(sink.z + n, _mm512_maskz_compress_pd(in, z));
    const __m256i index =
        run.index ? _mm256_maskz_loadu_epi32(live, run.index + i)
                  : _mm256_add_epi32(ramp, _mm256_set1_epi32(static_cast<int>(run.first_index + i)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(sink.index + n), _mm256_maskz_compress_epi32(in, index));
    if (run.radius)
      _mm512_storeu_pd(sink.radius + n,
                       _mm512_maskz_compress_pd(in, _mm512_maskz_loadu_pd(live, run.radius + i)));
    if (run.stiffness)
      _mm512_storeu_pd(sink.stiffness + n,
                       _mm512_maskz_compress_pd(in, _mm512_maskz_loadu_pd(live, run.stiffness + i)));
    n += static_cast<std::size_t>(__builtin_popcount(in));
  }
  return n;
}

#else

std::size_t append_one(const PointRun& run, std::size_t i, const PointSink& sink, std::size_t n) {
  sink.x[n] = run.x[i], sink.y[n] = run.y[i], sink.z[n] = run.z[i];
  sink.index[n] = run.index ? run.index[i] : run.first_index + static_cast<std::uint32_t>(i);
  if (run.radius) sink.radius[n] = run.radius[i];
  if (run.stiffness) sink.stiffness[n] = run.stiffness[i];
  return n + 1;
}

// Distances first, in a loop the compiler turns into vectors, then the survivors one by one.
std::size_t append_within(const PointRun& run, const double centre[3], double radius_squared,
                          const PointSink& sink, std::size_t n) {
  constexpr std::size_t kChunk = 64;
  double squared[kChunk];
  for (std::size_t start = 0; start < run.count; start += kChunk) {
    const std::size_t count = run.count - start < kChunk ? run.count - start : kChunk;
    const double *x = run.x + start, *y = run.y + start, *z = run.z + start;
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const double dx = x[i] - centre[0], dy = y[i] - centre[1], dz = z[i] - centre[2];
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (squared[i] <= radius_squared) n = append_one(run, start + i, sink, n);
  }
  return n;
}

#endif

// One pass: state (the nearest point), normal (4.1) with weights (4.2), and the stiffness sums of (5.8).
template <bool kRadius, bool kStiffness>
Survey survey_columns(const PointsView& points, const double p[3], const ProxyRegions& regions) {
  const double px = p[0], py = p[1], pz = p[2], r1 = regions.r1, r2 = regions.r2, grid = regions.sum_grid;
  const double scale = 1.0 / (regions.r3 - regions.r1);
  const double stiffness_grid = grid * 1048576.0;  // k_s is at most 2^20 N/m
  double nearest = __builtin_inf(), sx = 0, sy = 0, sz = 0, weights = 0, stiffness = 0, touching = 0;
  const double *x = points.x, *y = points.y, *z = points.z, *radius = points.radius, *k = points.stiffness;
#pragma omp simd reduction(min : nearest) reduction(+ : sx, sy, sz, weights, stiffness, touching)
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const double dx = px - x[i], dy = py - y[i], dz = pz - z[i];
    const double distance = __builtin_sqrt(dx * dx + dy * dy + dz * dz);
    const double r = kRadius ? distance - radius[i] : distance;
    const double psi = wendland(smaller(larger((r - r1) * scale, 0.0), 1.0));
    const double w = psi / larger(distance, 1e-150);  // a point at P itself adds 0 / 1e-150 = 0: skipped
    nearest = smaller(r, nearest);
    sx += (dx * w + grid) - grid;
    sy += (dy * w + grid) - grid;
    sz += (dz * w + grid) - grid;
    touching += r <= r2 ? 1.0 : 0.0;
    if (kStiffness) {
      weights += (psi + grid) - grid;
      stiffness += (psi * k[i] + stiffness_grid) - stiffness_grid;
    }
  }
  return {nearest, {sx, sy, sz}, weights, stiffness, touching};
}

Survey survey(const PointsView& points, const double p[3], const ProxyRegions& regions) {
  if (points.radius)
    return points.stiffness ? survey_columns<true, true>(points, p, regions)
                            : survey_columns<true, false>(points, p, regions);
  return points.stiffness ? survey_columns<false, true>(points, p, regions)
                          : survey_columns<false, false>(points, p, regions);
}

// The perpendicular form of the root: along is the foot of x on the ray and the offset is taken from it, so
// nothing cancels when x is far away. The discriminant form loses the 2e-5 m shell there.
template <bool kRadius>
double first_hit_columns(const PointsView& points, const double p[3], const double u[3], double reach) {
  const double px = p[0], py = p[1], pz = p[2], ux = u[0], uy = u[1], uz = u[2];
  double first = __builtin_inf();
  const double *x = points.x, *y = points.y, *z = points.z, *radius = points.radius;
#pragma omp simd reduction(min : first)
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const double ex = x[i] - px, ey = y[i] - py, ez = z[i] - pz;
    const double along = ex * ux + ey * uy + ez * uz;
    const double ox = ex - along * ux, oy = ey - along * uy, oz = ez - along * uz;
    const double r = kRadius ? reach + radius[i] : reach;
    const double rest = r * r - (ox * ox + oy * oy + oz * oz);
    const double root = along - __builtin_sqrt(larger(rest, 0.0));
    const bool met = (along > 0.0) & (rest >= 0.0) & (root > 0.0);  // ahead, a real root, not behind P
    first = smaller(met ? root : __builtin_inf(), first);
  }
  return first;
}

double first_hit(const PointsView& points, const double p[3], const double direction[3], double reach) {
  return points.radius ? first_hit_columns<true>(points, p, direction, reach)
                       : first_hit_columns<false>(points, p, direction, reach);
}

template <bool kRadius>
double way_out_columns(const PointsView& points, const double p[3], const double u[3], double reach,
                       double inner) {
  const double px = p[0], py = p[1], pz = p[2], ux = u[0], uy = u[1], uz = u[2];
  double longest = 0.0;
  const double *x = points.x, *y = points.y, *z = points.z, *radius = points.radius;
#pragma omp simd reduction(max : longest)
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const double ex = x[i] - px, ey = y[i] - py, ez = z[i] - pz;
    const double along = ex * ux + ey * uy + ez * uz;
    const double ox = ex - along * ux, oy = ey - along * uy, oz = ez - along * uz;
    const double rf = kRadius ? radius[i] : 0.0;
    const double r = reach + rf, limit = inner + rf;
    const double rest = r * r - (ox * ox + oy * oy + oz * oz);
    const bool entrenching = ex * ex + ey * ey + ez * ez < limit * limit;
    longest = larger(entrenching ? along + __builtin_sqrt(larger(rest, 0.0)) : 0.0, longest);
  }
  return longest;
}

double way_out(const PointsView& points, const double p[3], const double direction[3], double reach,
               double inner) {
  return points.radius ? way_out_columns<true>(points, p, direction, reach, inner)
                       : way_out_columns<false>(points, p, direction, reach, inner);
}

// --- noise: Philox4x32-10 (Salmon et al. 2011) and Box-Muller, with own elementary functions ---

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

}  // namespace

extern const Kernels REMOTE_TOUCH_KERNELS;
const Kernels REMOTE_TOUCH_KERNELS = {
    REMOTE_TOUCH_ISA_NAME, append_within, survey, first_hit, way_out, normals};

}  // namespace remote_touch
