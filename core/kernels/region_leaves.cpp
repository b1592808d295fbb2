// One leaf of a tool against a patch of forbidden regions, 7.4.1, and which of the pairs found matter. Pairs
// that are far apart are sorted out without a root; what is left is written close together, so that roots and
// divisions are taken for it alone.
#include <immintrin.h>
#include <math.h>

#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

constexpr double kRounding = 1 + 1e-12;  // no pair within the margin is sorted out by the rounding of squares

// One in so many has to be gone before the others close up: that takes time, later passes take less.
constexpr std::size_t kCloseUp = 8;

inline std::size_t in_whole_groups(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

// Leaves numbers of the regions that may be near, the ways from their centres in the columns of the normal,
// and their radii in that of the gap.
#if defined(__AVX512F__)

constexpr std::size_t kWidth = 8;
inline unsigned equal(const double* p, double value) {
  return _mm512_cmp_pd_mask(_mm512_loadu_pd(p), _mm512_set1_pd(value), _CMP_EQ_OQ);
}

std::size_t sort_out(const SphereRun& run, const double leaf[4], double margin, const NearRegions& to,
                     std::size_t n) {
  const __m512d cx = _mm512_set1_pd(leaf[0]), cy = _mm512_set1_pd(leaf[1]), cz = _mm512_set1_pd(leaf[2]),
                own = _mm512_set1_pd(leaf[3] + margin), wider = _mm512_set1_pd(kRounding);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  for (std::size_t i = 0; i < run.padded_count; i += kLanes) {
    const __m512d x = _mm512_sub_pd(cx, _mm512_loadu_pd(run.x + i)),
                  y = _mm512_sub_pd(cy, _mm512_loadu_pd(run.y + i)),
                  z = _mm512_sub_pd(cz, _mm512_loadu_pd(run.z + i)), radius = _mm512_loadu_pd(run.radius + i);
    const __m512d squared =
        _mm512_add_pd(_mm512_mul_pd(x, x), _mm512_add_pd(_mm512_mul_pd(y, y), _mm512_mul_pd(z, z)));
    const __m512d reach = _mm512_mul_pd(_mm512_add_pd(own, radius), wider);
    __mmask8 in = _mm512_cmp_pd_mask(squared, _mm512_mul_pd(reach, reach), _CMP_LE_OQ);
    in = _mm512_mask_cmp_pd_mask(in, reach, _mm512_setzero_pd(), _CMP_GE_OQ);
    if (in == 0) continue;
    _mm512_storeu_pd(to.nx + n, _mm512_maskz_compress_pd(in, x));
    _mm512_storeu_pd(to.ny + n, _mm512_maskz_compress_pd(in, y));
    _mm512_storeu_pd(to.nz + n, _mm512_maskz_compress_pd(in, z));
    _mm512_storeu_pd(to.gap + n, _mm512_maskz_compress_pd(in, radius));
    const __m256i number = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(run.first + i)));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.number + n), _mm256_maskz_compress_epi32(in, number));
    n += static_cast<std::size_t>(__builtin_popcount(in));
  }
  return n;
}

#else

#if defined(__AVX2__)
constexpr std::size_t kWidth = 4;
using Lanes = __m256d;
inline Lanes load(const double* p) {
  return _mm256_loadu_pd(p);
}
template <class Mask>
inline unsigned bits(Mask mask) {
  return static_cast<unsigned>(_mm256_movemask_pd((__m256d)mask));
}
#else
constexpr std::size_t kWidth = 2;
using Lanes = __m128d;
inline Lanes load(const double* p) {
  return _mm_loadu_pd(p);
}
template <class Mask>
inline unsigned bits(Mask mask) {
  return static_cast<unsigned>(_mm_movemask_pd((__m128d)mask));
}
#endif

inline unsigned equal(const double* p, double value) {
  return bits(load(p) == Lanes{} + value);
}

std::size_t sort_out(const SphereRun& run, const double leaf[4], double margin, const NearRegions& to,
                     std::size_t n) {
  const Lanes zero = {}, cx = zero + leaf[0], cy = zero + leaf[1], cz = zero + leaf[2],
              own = zero + (leaf[3] + margin);
  for (std::size_t i = 0; i < run.padded_count; i += kWidth) {
    const Lanes x = cx - load(run.x + i), y = cy - load(run.y + i), z = cz - load(run.z + i);
    const Lanes reach = (own + load(run.radius + i)) * kRounding;
    for (unsigned in = bits((x * x + (y * y + z * z) <= reach * reach) & (reach >= zero)); in != 0;
         in &= in - 1) {
      const std::size_t lane = static_cast<std::size_t>(__builtin_ctz(in)), at = i + lane;
      to.nx[n] = x[lane], to.ny[n] = y[lane], to.nz[n] = z[lane];
      to.gap[n] = run.radius[at];
      to.number[n++] = run.first + static_cast<std::uint32_t>(at);
    }
  }
  return n;
}

#endif

// From ways and radii to unit normals and gaps, in whole groups: what lies beyond the last is not read.
void measure(double leaf_radius, const NearRegions& near, std::size_t from, std::size_t to) {
  const std::size_t end = from + in_whole_groups(to - from);
  for (std::size_t group = from; group < end; group += kLanes)
#pragma omp simd
    for (std::size_t i = group; i < group + kLanes; ++i) {
      const double x = near.nx[i], y = near.ny[i], z = near.nz[i];
      const double distance = sqrt(x * x + (y * y + z * z));
      const bool has_way = distance > 0;
      const double per_length = 1 / (has_way ? distance : 1);
      near.nx[i] = x * per_length;
      near.ny[i] = has_way ? y * per_length : 1;
      near.nz[i] = z * per_length;
      near.gap[i] = distance - leaf_radius - near.gap[i];
    }
}

// Those with gaps above the margin go, and the others close up, with or without their numbers; of those whose
// gaps turned out to be so most often there are none. What is written lies never behind what was read.
#if defined(__AVX512F__)

template <bool kNumbers>
std::size_t within_margin(const NearRegions& near, double margin, std::size_t from, std::size_t to) {
  const __m512d most = _mm512_set1_pd(margin);
  std::size_t n = from;
  for (std::size_t i = from; i < to; i += kLanes) {
    const __m512d gap = _mm512_loadu_pd(near.gap + i);
    const auto valid = static_cast<__mmask8>(to - i < kLanes ? (1u << (to - i)) - 1 : 0xffu);
    const __mmask8 in = _mm512_mask_cmp_pd_mask(valid, gap, most, _CMP_LE_OQ);
    const auto left = static_cast<std::size_t>(__builtin_popcount(in));
    if (n == i && in == valid) {
      n += left;
      continue;
    }
    _mm512_storeu_pd(near.gap + n, _mm512_maskz_compress_pd(in, gap));
    double* const columns[] = {near.nx, near.ny, near.nz};
    for (double* column : columns)
      _mm512_storeu_pd(column + n, _mm512_maskz_compress_pd(in, _mm512_loadu_pd(column + i)));
    if (kNumbers) {
      const auto at = [&](std::size_t j) { return reinterpret_cast<__m256i*>(near.number + j); };
      _mm256_storeu_si256(at(n), _mm256_maskz_compress_epi32(in, _mm256_loadu_si256(at(i))));
    }
    n += left;
  }
  return n;
}

#else

template <bool kNumbers>
std::size_t within_margin(const NearRegions& near, double margin, std::size_t from, std::size_t to) {
  std::size_t n = from;
  for (std::size_t i = from; i < to; ++i) {
    if (!(near.gap[i] <= margin)) continue;
    if (i != n) {
      near.gap[n] = near.gap[i];
      near.nx[n] = near.nx[i], near.ny[n] = near.ny[i], near.nz[n] = near.nz[i];
      if (kNumbers) near.number[n] = near.number[i];
    }
    ++n;
  }
  return n;
}

#endif

// The first of those with the least gap; pre: there is one. Whether there is must not be asked of the least
// gap: of no numbers an OpenMP minimum may be the largest finite one, as clang++ has it, instead of infinite.
std::size_t deepest(const double* gap, double least) {
  std::size_t at = 0;
  unsigned same = equal(gap, least);
  while (same == 0) same = equal(gap += kWidth, least), at += kWidth;
  return at + static_cast<std::size_t>(__builtin_ctz(same));
}

}  // namespace

std::size_t append_near_regions(const SphereRun& run, const double leaf[4], double margin,
                                const NearRegions& near, std::size_t count) {
  const std::size_t end = sort_out(run, leaf, margin, near, count);
  if (end == count) return count;
  measure(leaf[3], near, count, end);
  return within_margin<true>(near, margin, count, end);
}

std::size_t deepest_region(const NearRegions& near, std::size_t count) {
  if (count == 0) return 0;
  const std::size_t end = in_whole_groups(count);
  for (std::size_t i = count; i < end; ++i) near.gap[i] = __builtin_inf();
  const double* gap = near.gap;
  double least = __builtin_inf();
#pragma omp simd reduction(min : least)
  for (std::size_t i = 0; i < end; ++i) least = gap[i] < least ? gap[i] : least;
  return deepest(gap, least);
}

LeftRegions next_deepest_region(const NearRegions& near, std::size_t count, std::size_t kept, double motion,
                                double alike, double most) {
  const double g = near.gap[kept], kx = near.nx[kept], ky = near.ny[kept], kz = near.nz[kept];
  near.gap[kept] = __builtin_inf();
  const double twice_squared = 2 * (motion * motion);
  const std::size_t end = in_whole_groups(count);
  double* gap = near.gap;
  const double *nx = near.nx, *ny = near.ny, *nz = near.nz;
  double least = __builtin_inf();
  std::size_t left = 0;
#pragma omp simd reduction(min : least) reduction(+ : left)
  for (std::size_t i = 0; i < end; ++i) {
    const double cosine = nx[i] * kx + (ny[i] * ky + nz[i] * kz);
    const double rise = gap[i] - g;
    const bool goes = ((rise * rise >= twice_squared * (1 - cosine)) & (cosine >= alike)) | !(gap[i] <= most);
    gap[i] = goes ? __builtin_inf() : gap[i];
    least = gap[i] < least ? gap[i] : least;
    left += goes ? 0 : 1;
  }
  if (kCloseUp * left <= (kCloseUp - 1) * count) {
    count = within_margin<false>(near, most, 0, count);
    for (std::size_t i = count; i < in_whole_groups(count); ++i) gap[i] = __builtin_inf();
  }
  return {left > 0 ? deepest(gap, least) : count, count};
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
