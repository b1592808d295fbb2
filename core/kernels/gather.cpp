// Copies the points in a ball from the runs that a neighbour search visits. The comparison is the same on
// every level, so the set of points is the same too. The functions copy their arguments, because otherwise
// the compiler would reread them after each store. Most points of an image window qualify, so the functions
// do not skip groups without a qualifying point: the mispredicted branches would cost more than they save. If
// there are radii, the window is that of the largest region, and most points do not qualify, so groups are
// skipped.
#include <immintrin.h>

#include "core/kernels/level.h"
#include "core/kernels/point_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

#if defined(__AVX512F__)

template <bool kIndexed, bool kExtra>
std::size_t append_columns(PointRun run, const double centre[3], double reach, const PointSink& to,
                           std::size_t n) {
  const PointSink sink = to;
  const bool skip = run.rows == 1 || (kExtra && run.radius);
  const __m512d cx = _mm512_set1_pd(centre[0]), cy = _mm512_set1_pd(centre[1]),
                cz = _mm512_set1_pd(centre[2]), ball = _mm512_set1_pd(reach),
                all = _mm512_set1_pd(reach * reach);
  __m256i row_index = _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
                                       _mm256_set1_epi32(static_cast<int>(run.first_index)));
  const __m256i row_step = _mm256_set1_epi32(static_cast<int>(run.stride));
  for (std::size_t row = 0, start = 0; row < run.rows; ++row, start += run.stride) {
    __m256i index = row_index;
    row_index = _mm256_add_epi32(row_index, row_step);
    for (std::size_t i = start; i < start + run.count; i += kLanes) {
      const std::size_t left = start + run.count - i;
      const auto live =
          static_cast<__mmask8>(_bzhi_u32(0xff, left < kLanes ? static_cast<unsigned>(left) : 8));
      const __m512d x = _mm512_maskz_loadu_pd(live, run.x + i), y = _mm512_maskz_loadu_pd(live, run.y + i),
                    z = _mm512_maskz_loadu_pd(live, run.z + i);
      const __m512d dx = _mm512_sub_pd(x, cx), dy = _mm512_sub_pd(y, cy), dz = _mm512_sub_pd(z, cz);
      const __m512d squared =
          _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy)), _mm512_mul_pd(dz, dz));
      __m512d radius = ball, limit = all;
      if (kExtra && run.radius) {
        radius = _mm512_maskz_loadu_pd(live, run.radius + i);
        const __m512d far = _mm512_add_pd(ball, radius);
        limit = _mm512_mul_pd(far, far);
      }
      const __mmask8 in = _mm512_mask_cmp_pd_mask(live, squared, limit, _CMP_LE_OQ);
      if (kIndexed) index = _mm256_maskz_loadu_epi32(live, run.index + i);
      const __m256i found = _mm256_maskz_compress_epi32(in, index);
      if (!kIndexed) index = _mm256_add_epi32(index, _mm256_set1_epi32(kLanes));
      if (skip & (in == 0)) continue;
      _mm512_storeu_pd(sink.x + n, _mm512_maskz_compress_pd(in, x));
      _mm512_storeu_pd(sink.y + n, _mm512_maskz_compress_pd(in, y));
      _mm512_storeu_pd(sink.z + n, _mm512_maskz_compress_pd(in, z));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(sink.index + n), found);
      if (kExtra && run.radius) _mm512_storeu_pd(sink.radius + n, _mm512_maskz_compress_pd(in, radius));
      if (kExtra && run.stiffness)
        _mm512_storeu_pd(sink.stiffness + n,
                         _mm512_maskz_compress_pd(in, _mm512_maskz_loadu_pd(live, run.stiffness + i)));
      n += static_cast<std::size_t>(__builtin_popcount(in));
    }
  }
  return n;
}

#elif defined(__AVX2__)

// The source indices of the qualifying points among four, for each set of them, as pairs of 32-bit words and
// as single words.
struct Squeeze {
  alignas(32) std::int32_t pair[16][8];
  alignas(16) std::int32_t word[16][4];
  constexpr Squeeze() : pair{}, word{} {
    for (int in = 0; in < 16; ++in)
      for (int from = 0, to = 0; from < 4; ++from)
        if (in >> from & 1)
          pair[in][2 * to] = 2 * from, pair[in][2 * to + 1] = 2 * from + 1, word[in][to++] = from;
  }
};
constexpr Squeeze kSqueeze;

template <bool kIndexed, bool kExtra>
std::size_t append_columns(PointRun run, const double centre[3], double reach, const PointSink& to,
                           std::size_t n) {
  const PointSink sink = to;
  const bool skip = run.rows == 1 || (kExtra && run.radius);
  const __m256d cx = _mm256_set1_pd(centre[0]), cy = _mm256_set1_pd(centre[1]),
                cz = _mm256_set1_pd(centre[2]), ball = _mm256_set1_pd(reach),
                all = _mm256_set1_pd(reach * reach);
  const __m256i lanes = _mm256_setr_epi64x(0, 1, 2, 3);
  const __m128i words = _mm_setr_epi32(0, 1, 2, 3);
  __m128i row_index = _mm_add_epi32(words, _mm_set1_epi32(static_cast<int>(run.first_index)));
  const __m128i row_step = _mm_set1_epi32(static_cast<int>(run.stride));
  for (std::size_t row = 0, start = 0; row < run.rows; ++row, start += run.stride) {
    __m128i index = row_index;
    row_index = _mm_add_epi32(row_index, row_step);
    for (std::size_t i = start; i < start + run.count; i += 4) {
      const auto left = static_cast<long long>(start + run.count - i);
      const __m256i live = _mm256_cmpgt_epi64(_mm256_set1_epi64x(left), lanes);
      const __m256d x = _mm256_maskload_pd(run.x + i, live), y = _mm256_maskload_pd(run.y + i, live),
                    z = _mm256_maskload_pd(run.z + i, live);
      const __m256d dx = _mm256_sub_pd(x, cx), dy = _mm256_sub_pd(y, cy), dz = _mm256_sub_pd(z, cz);
      const __m256d squared =
          _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(dx, dx), _mm256_mul_pd(dy, dy)), _mm256_mul_pd(dz, dz));
      __m256d radius = ball, limit = all;
      if (kExtra && run.radius) {
        radius = _mm256_maskload_pd(run.radius + i, live);
        const __m256d far = _mm256_add_pd(ball, radius);
        limit = _mm256_mul_pd(far, far);
      }
      const int in = _mm256_movemask_pd(
          _mm256_and_pd(_mm256_cmp_pd(squared, limit, _CMP_LE_OQ), _mm256_castsi256_pd(live)));
      const __m128i here = index;
      index = _mm_add_epi32(index, _mm_set1_epi32(4));
      if (skip & (in == 0)) continue;
      const __m256i from = _mm256_load_si256(reinterpret_cast<const __m256i*>(kSqueeze.pair[in]));
      const auto put = [&](double* column, __m256d v) {
        _mm256_storeu_pd(column + n,
                         _mm256_castsi256_pd(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(v), from)));
      };
      put(sink.x, x), put(sink.y, y), put(sink.z, z);
      if (kExtra && run.radius) put(sink.radius, radius);
      if (kExtra && run.stiffness) put(sink.stiffness, _mm256_maskload_pd(run.stiffness + i, live));
      const __m128i source =
          kIndexed ? _mm_maskload_epi32(
                         reinterpret_cast<const int*>(run.index + i),
                         _mm_cmpgt_epi32(_mm_set1_epi32(static_cast<int>(left < 4 ? left : 4)), words))
                   : here;
      const __m128i squeezed = _mm_castps_si128(_mm_permutevar_ps(
          _mm_castsi128_ps(source), _mm_load_si128(reinterpret_cast<const __m128i*>(kSqueeze.word[in]))));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(sink.index + n), squeezed);
      n += static_cast<std::size_t>(__builtin_popcount(static_cast<unsigned>(in)));
    }
  }
  return n;
}

#else

// Stores every point; only a qualifying point advances the end.
template <bool kIndexed, bool kExtra>
std::size_t append_short(const PointRun& run, std::size_t start, const double centre[3], double reach,
                         const PointSink& sink, std::size_t n) {
  const double cx = centre[0], cy = centre[1], cz = centre[2];
  const double *xs = run.x, *ys = run.y, *zs = run.z;
  const std::uint32_t *indices = run.index, first = run.first_index;
  double *x_out = sink.x, *y_out = sink.y, *z_out = sink.z;
  std::uint32_t* index_out = sink.index;
  for (std::size_t i = start; i < start + run.count; ++i) {
    const double x = xs[i], y = ys[i], z = zs[i];
    const double dx = x - cx, dy = y - cy, dz = z - cz;
    x_out[n] = x, y_out[n] = y, z_out[n] = z;
    index_out[n] = kIndexed ? indices[i] : first + static_cast<std::uint32_t>(i);
    if (kExtra && run.radius) sink.radius[n] = run.radius[i];
    if (kExtra && run.stiffness) sink.stiffness[n] = run.stiffness[i];
    const double far = kExtra && run.radius ? reach + run.radius[i] : reach;
    n += dx * dx + dy * dy + dz * dz <= far * far ? 1 : 0;
  }
  return n;
}

// Computes the distances first, in a loop that the compiler vectorises, then stores the qualifying points,
// which are few among many.
template <bool kIndexed, bool kExtra>
std::size_t append_long(const PointRun& run, std::size_t start, const double centre[3], double reach,
                        const PointSink& sink, std::size_t n) {
  constexpr std::size_t kChunk = 64;
  double squared[kChunk];
  for (std::size_t done = 0; done < run.count; done += kChunk) {
    const std::size_t count = run.count - done < kChunk ? run.count - done : kChunk, at = start + done;
    const double *x = run.x + at, *y = run.y + at, *z = run.z + at;
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const double dx = x[i] - centre[0], dy = y[i] - centre[1], dz = z[i] - centre[2];
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double far = kExtra && run.radius ? reach + run.radius[at + i] : reach;
      if (!(squared[i] <= far * far)) continue;
      sink.x[n] = x[i], sink.y[n] = y[i], sink.z[n] = z[i];
      sink.index[n] = kIndexed ? run.index[at + i] : run.first_index + static_cast<std::uint32_t>(at + i);
      if (kExtra && run.radius) sink.radius[n] = run.radius[at + i];
      if (kExtra && run.stiffness) sink.stiffness[n] = run.stiffness[at + i];
      ++n;
    }
  }
  return n;
}

template <bool kIndexed, bool kExtra>
std::size_t append_columns(const PointRun& run, const double centre[3], double reach, const PointSink& sink,
                           std::size_t n) {
  for (std::size_t row = 0, start = 0; row < run.rows; ++row, start += run.stride)
    n = run.count <= 64 ? append_short<kIndexed, kExtra>(run, start, centre, reach, sink, n)
                        : append_long<kIndexed, kExtra>(run, start, centre, reach, sink, n);
  return n;
}

#endif

}  // namespace

std::size_t append_within(const PointRun& run, const double centre[3], double reach, const PointSink& sink,
                          std::size_t n) {
  const bool extra = run.radius || run.stiffness;
  if (run.index)
    return extra ? append_columns<true, true>(run, centre, reach, sink, n)
                 : append_columns<true, false>(run, centre, reach, sink, n);
  return extra ? append_columns<false, true>(run, centre, reach, sink, n)
               : append_columns<false, false>(run, centre, reach, sink, n);
}

const GatherKernels kGatherKernels = {.append_within = append_within};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
