// Detection between one leaf of a tool and a patch of forbidden regions, 7.4.1, and selection of the pairs
// that matter. Groups of regions whose boxes are too far away are skipped, and pairs that are far apart are
// rejected without a root. The remaining pairs are stored close together, so that roots and divisions are
// computed for them alone.
#include <math.h>

#include "core/kernels/lanes.h"
#include "core/kernels/level.h"
#include "core/kernels/point_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

constexpr double kRounding = 1 + 1e-12;  // factor: rounding of squares never rejects a pair within the margin

// The remaining regions are moved together when one in kCloseUp has been removed: this costs time, but saves
// more in later passes.
constexpr std::size_t kCloseUp = 8;

inline std::size_t in_whole_groups(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

// boxes_near() returns a mask of the groups, kWidth at a time, that may contain a region which sort_group()
// would keep. The test is conservative, also after rounding: each of its distances is at most that of any
// sphere of the group, and its reach is at least that of any. sort_group() selects the regions of a group
// that may be near. It stores their numbers, the vectors from their centres to the leaf in the columns of the
// normal, and their radii in the column of the gap.
#if defined(__AVX512F__)

constexpr std::size_t kWidth = 8;
inline unsigned equal(const double* p, double value) {
  return _mm512_cmp_pd_mask(_mm512_loadu_pd(p), _mm512_set1_pd(value), _CMP_EQ_OQ);
}

struct Leaf {
  __m512d x, y, z, own;  // own: radius of the leaf plus the margin

  Leaf(const double leaf[4], double margin)
      : x(_mm512_set1_pd(leaf[0])),
        y(_mm512_set1_pd(leaf[1])),
        z(_mm512_set1_pd(leaf[2])),
        own(_mm512_set1_pd(leaf[3] + margin)) {}
};

inline __mmask8 within_reach(__m512d x, __m512d y, __m512d z, __m512d own, __m512d radius) {
  const __m512d squared =
      _mm512_add_pd(_mm512_mul_pd(x, x), _mm512_add_pd(_mm512_mul_pd(y, y), _mm512_mul_pd(z, z)));
  const __m512d reach = _mm512_mul_pd(_mm512_add_pd(own, radius), _mm512_set1_pd(kRounding));
  const __mmask8 in = _mm512_cmp_pd_mask(squared, _mm512_mul_pd(reach, reach), _CMP_LE_OQ);
  return _mm512_mask_cmp_pd_mask(in, reach, _mm512_setzero_pd(), _CMP_GE_OQ);
}

inline unsigned boxes_near(const Leaf& leaf, const SphereRun& run, std::size_t g) {
  const auto beyond = [g](__m512d c, const double* low, const double* high) {
    const __m512d below = _mm512_sub_pd(_mm512_loadu_pd(low + g), c),
                  above = _mm512_sub_pd(c, _mm512_loadu_pd(high + g));
    return _mm512_max_pd(_mm512_max_pd(below, above), _mm512_setzero_pd());
  };
  return within_reach(beyond(leaf.x, run.low[0], run.high[0]), beyond(leaf.y, run.low[1], run.high[1]),
                      beyond(leaf.z, run.low[2], run.high[2]), leaf.own, _mm512_loadu_pd(run.max_radius + g));
}

inline std::size_t sort_group(const Leaf& leaf, const SphereRun& run, std::size_t i, const NearRegions& to,
                              std::size_t n) {
  const __m512d x = _mm512_sub_pd(leaf.x, _mm512_loadu_pd(run.x + i)),
                y = _mm512_sub_pd(leaf.y, _mm512_loadu_pd(run.y + i)),
                z = _mm512_sub_pd(leaf.z, _mm512_loadu_pd(run.z + i)),
                radius = _mm512_loadu_pd(run.radius + i);
  const __mmask8 in = within_reach(x, y, z, leaf.own, radius);
  _mm512_storeu_pd(to.nx + n, _mm512_maskz_compress_pd(in, x));
  _mm512_storeu_pd(to.ny + n, _mm512_maskz_compress_pd(in, y));
  _mm512_storeu_pd(to.nz + n, _mm512_maskz_compress_pd(in, z));
  _mm512_storeu_pd(to.gap + n, _mm512_maskz_compress_pd(in, radius));
  const __m256i number = _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
                                          _mm256_set1_epi32(static_cast<int>(run.first + i)));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to.number + n), _mm256_maskz_compress_epi32(in, number));
  return n + static_cast<std::size_t>(__builtin_popcount(in));
}

#else

constexpr std::size_t kWidth = kDoubles;
using Lanes = Doubles;

inline unsigned equal(const double* p, double value) {
  return mask_of(load(p) == Lanes{} + value);
}

struct Leaf {
  Lanes x, y, z, own;  // own: radius of the leaf plus the margin

  Leaf(const double leaf[4], double margin)
      : x(Lanes{} + leaf[0]), y(Lanes{} + leaf[1]), z(Lanes{} + leaf[2]), own(Lanes{} + (leaf[3] + margin)) {}
};

inline unsigned within_reach(Lanes x, Lanes y, Lanes z, Lanes own, Lanes radius) {
  const Lanes reach = (own + radius) * kRounding;
  return mask_of((x * x + (y * y + z * z) <= reach * reach) & (reach >= Lanes{}));
}

inline unsigned boxes_near(const Leaf& leaf, const SphereRun& run, std::size_t g) {
  const auto beyond = [g](Lanes c, const double* low, const double* high) {
    return larger(larger(load(low + g) - c, c - load(high + g)), Lanes{});
  };
  return within_reach(beyond(leaf.x, run.low[0], run.high[0]), beyond(leaf.y, run.low[1], run.high[1]),
                      beyond(leaf.z, run.low[2], run.high[2]), leaf.own, load(run.max_radius + g));
}

inline std::size_t sort_group(const Leaf& leaf, const SphereRun& run, std::size_t group,
                              const NearRegions& to, std::size_t n) {
  for (std::size_t i = group; i < group + kLanes; i += kWidth) {
    const Lanes x = leaf.x - load(run.x + i), y = leaf.y - load(run.y + i), z = leaf.z - load(run.z + i);
    for (unsigned in = within_reach(x, y, z, leaf.own, load(run.radius + i)); in != 0; in &= in - 1) {
      const std::size_t lane = static_cast<std::size_t>(__builtin_ctz(in)), at = i + lane;
      to.nx[n] = x[lane], to.ny[n] = y[lane], to.nz[n] = z[lane];
      to.gap[n] = run.radius[at];
      to.number[n++] = run.first + static_cast<std::uint32_t>(at);
    }
  }
  return n;
}

#endif

std::size_t sort_out(const SphereRun& run, const double columns[4], double margin, const NearRegions& to,
                     std::size_t n) {
  const Leaf leaf(columns, margin);
  for (std::size_t first = 0; first < run.padded_groups; first += kWidth)
    for (unsigned near = boxes_near(leaf, run, first); near != 0; near &= near - 1) {
      const std::size_t group = first + static_cast<std::size_t>(__builtin_ctz(near));
      n = sort_group(leaf, run, kLanes * group, to, n);
    }
  return n;
}

// Converts vectors and radii to unit normals and gaps, in whole groups. Values after the last region are
// never read.
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

// Removes the regions whose gaps are above the margin and moves the others together. kNumbers: also moves
// their numbers. Most calls remove none. The write position never passes the read position.
#if defined(__AVX512F__)

template <bool kNumbers>
std::size_t within_margin(const NearRegions& near, double margin, std::size_t from, std::size_t to) {
  const __m512d max = _mm512_set1_pd(margin);
  std::size_t n = from;
  for (std::size_t i = from; i < to; i += kLanes) {
    const __m512d gap = _mm512_loadu_pd(near.gap + i);
    const auto valid = static_cast<__mmask8>(to - i < kLanes ? (1u << (to - i)) - 1 : 0xffu);
    const __mmask8 in = _mm512_mask_cmp_pd_mask(valid, gap, max, _CMP_LE_OQ);
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

// Returns the first index with the smallest gap. pre: there is a region. The caller must not conclude this
// from `min`: if no gap is finite, the minimum that OpenMP computes may be the largest finite number instead
// of infinity, as with clang++.
std::size_t deepest(const double* gap, double min) {
  std::size_t at = 0;
  unsigned same = equal(gap, min);
  while (same == 0) same = equal(gap += kWidth, min), at += kWidth;
  return at + static_cast<std::size_t>(__builtin_ctz(same));
}

struct Kept {
  double nx, ny, nz, gap, twice_motion_squared, alike;
};
struct Left {
  double min;  // smallest gap
  std::size_t count;
};

// Sets the gaps of the regions that `by` makes redundant, and all gaps above max, to infinity. Returns the
// smallest remaining gap and the number of remaining regions.
#if defined(__AVX512F__)

Left remove_redundant(const NearRegions& near, std::size_t end, const Kept& by, double max) {
  const __m512d kx = _mm512_set1_pd(by.nx), ky = _mm512_set1_pd(by.ny), kz = _mm512_set1_pd(by.nz),
                g = _mm512_set1_pd(by.gap), twice = _mm512_set1_pd(by.twice_motion_squared),
                alike = _mm512_set1_pd(by.alike), one = _mm512_set1_pd(1), limit = _mm512_set1_pd(max),
                infinite = _mm512_set1_pd(__builtin_inf());
  __m512d min = infinite;
  std::size_t count = 0;
  for (std::size_t i = 0; i < end; i += kLanes) {
    const __m512d gap = _mm512_loadu_pd(near.gap + i);
    const __m512d cosine = _mm512_add_pd(_mm512_mul_pd(_mm512_loadu_pd(near.nx + i), kx),
                                         _mm512_add_pd(_mm512_mul_pd(_mm512_loadu_pd(near.ny + i), ky),
                                                       _mm512_mul_pd(_mm512_loadu_pd(near.nz + i), kz)));
    const __m512d rise = _mm512_sub_pd(gap, g);
    __mmask8 is_redundant = _mm512_cmp_pd_mask(_mm512_mul_pd(rise, rise),
                                               _mm512_mul_pd(twice, _mm512_sub_pd(one, cosine)), _CMP_GE_OQ);
    is_redundant = _mm512_mask_cmp_pd_mask(is_redundant, cosine, alike, _CMP_GE_OQ);
    const __mmask8 stays = _mm512_mask_cmp_pd_mask(_mm512_knot(is_redundant), gap, limit, _CMP_LE_OQ);
    const __m512d left = _mm512_mask_blend_pd(stays, infinite, gap);
    _mm512_storeu_pd(near.gap + i, left);
    min = _mm512_min_pd(left, min);
    count += static_cast<std::size_t>(__builtin_popcount(stays));
  }
  return {_mm512_reduce_min_pd(min), count};
}

#else

Left remove_redundant(const NearRegions& near, std::size_t end, const Kept& by, double max) {
  double* gap = near.gap;
  const double *nx = near.nx, *ny = near.ny, *nz = near.nz;
  double min = __builtin_inf();
  std::size_t count = 0;
#pragma omp simd reduction(min : min) reduction(+ : count)
  for (std::size_t i = 0; i < end; ++i) {
    const double cosine = nx[i] * by.nx + (ny[i] * by.ny + nz[i] * by.nz);
    const double rise = gap[i] - by.gap;
    const bool is_removed =
        ((rise * rise >= by.twice_motion_squared * (1 - cosine)) & (cosine >= by.alike)) | !(gap[i] <= max);
    gap[i] = is_removed ? __builtin_inf() : gap[i];
    min = gap[i] < min ? gap[i] : min;
    count += is_removed ? 0 : 1;
  }
  return {min, count};
}

#endif

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
  double min = __builtin_inf();
#pragma omp simd reduction(min : min)
  for (std::size_t i = 0; i < end; ++i) min = gap[i] < min ? gap[i] : min;
  return deepest(gap, min);
}

RemainingRegions next_deepest_region(const NearRegions& near, std::size_t count, std::size_t kept,
                                     double motion, double alike, double max) {
  const Kept by{near.nx[kept], near.ny[kept], near.nz[kept], near.gap[kept], 2 * (motion * motion), alike};
  near.gap[kept] = __builtin_inf();
  const Left left = remove_redundant(near, in_whole_groups(count), by, max);
  if (kCloseUp * left.count <= (kCloseUp - 1) * count) {
    count = within_margin<false>(near, max, 0, count);
    for (std::size_t i = count; i < in_whole_groups(count); ++i) near.gap[i] = __builtin_inf();
  }
  return {left.count > 0 ? deepest(near.gap, left.min) : count, count};
}

const RegionKernels kRegionKernels = {.append_near_regions = append_near_regions,
                                      .deepest_region = deepest_region,
                                      .next_deepest_region = next_deepest_region};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
