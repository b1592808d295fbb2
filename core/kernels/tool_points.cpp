// Detection of points in the relevant cells of a tool, 6.2.2. Each point is transformed to the frame of the
// cells, and the value of its cell is read. The operations of the transform have the same order on every
// level, so the cell of a point is the same too.
#include <immintrin.h>

#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

#if defined(__AVX512F__)

namespace {

// Returns a coordinate of eight points in cells, rounded towards zero. NaN and values beyond the range of
// integers become negative.
inline __m256i coordinate(const double row[4], __m512d x, __m512d y, __m512d z) {
  const __m512d along = _mm512_add_pd(
      _mm512_add_pd(_mm512_mul_pd(_mm512_set1_pd(row[0]), x), _mm512_mul_pd(_mm512_set1_pd(row[1]), y)),
      _mm512_mul_pd(_mm512_set1_pd(row[2]), z));
  return _mm512_cvttpd_epi32(_mm512_add_pd(along, _mm512_set1_pd(row[3])));
}

}  // namespace

std::size_t points_in_cells(const double* x, const double* y, const double* z, const std::uint32_t* groups,
                            std::size_t group_count, const CellTransform& to_cells, const CellTable& table,
                            int min, std::uint32_t* found) {
  const __m256i columns = _mm256_set1_epi32(table.cells[0]), rows = _mm256_set1_epi32(table.cells[1]),
                layers = _mm256_set1_epi32(table.cells[2]), limit = _mm256_set1_epi32(min);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t at = kLanes * std::size_t{groups[g]};
    const __m512d px = _mm512_loadu_pd(x + at), py = _mm512_loadu_pd(y + at), pz = _mm512_loadu_pd(z + at);
    const __m256i i = coordinate(to_cells.row[0], px, py, pz), j = coordinate(to_cells.row[1], px, py, pz),
                  k = coordinate(to_cells.row[2], px, py, pz);
    __mmask8 in = _mm256_cmplt_epu32_mask(i, columns);
    in = _mm256_mask_cmplt_epu32_mask(in, j, rows);
    in = _mm256_mask_cmplt_epu32_mask(in, k, layers);
    if (in == 0) continue;
    const __m256i cell =
        _mm256_add_epi32(_mm256_mullo_epi32(_mm256_add_epi32(_mm256_mullo_epi32(k, rows), j), columns), i);
    const __m256i words = _mm256_mmask_i32gather_epi32(_mm256_setzero_si256(), in, cell,
                                                       reinterpret_cast<const int*>(table.value), 1);
    const __m256i values = _mm256_srai_epi32(_mm256_slli_epi32(words, 24), 24);
    in = _mm256_mask_cmpge_epi32_mask(in, values, limit);
    const __m256i number = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(at)));
    // The compressing store instruction is avoided, because it needs a hundred cycles on some processors;
    // found has room for whole groups.
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(found + n), _mm256_maskz_compress_epi32(in, number));
    n += static_cast<std::size_t>(__builtin_popcount(in));
  }
  return n;
}

#else

namespace {

#if defined(__AVX2__)
constexpr std::size_t kWidth = 4;
inline void store_coordinate(const double row[4], const double* x, const double* y, const double* z,
                             std::int32_t* out) {
  const __m256d along =
      _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(_mm256_set1_pd(row[0]), _mm256_loadu_pd(x)),
                                  _mm256_mul_pd(_mm256_set1_pd(row[1]), _mm256_loadu_pd(y))),
                    _mm256_mul_pd(_mm256_set1_pd(row[2]), _mm256_loadu_pd(z)));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out),
                   _mm256_cvttpd_epi32(_mm256_add_pd(along, _mm256_set1_pd(row[3]))));
}
#else
constexpr std::size_t kWidth = 2;
inline void store_coordinate(const double row[4], const double* x, const double* y, const double* z,
                             std::int32_t* out) {
  const __m128d along = _mm_add_pd(_mm_add_pd(_mm_mul_pd(_mm_set1_pd(row[0]), _mm_loadu_pd(x)),
                                              _mm_mul_pd(_mm_set1_pd(row[1]), _mm_loadu_pd(y))),
                                   _mm_mul_pd(_mm_set1_pd(row[2]), _mm_loadu_pd(z)));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(out), _mm_cvttpd_epi32(_mm_add_pd(along, _mm_set1_pd(row[3]))));
}
#endif

}  // namespace

// Computes the coordinates of eight points in vectors, then reads the cells one by one, because few points
// are inside the grid.
std::size_t points_in_cells(const double* x, const double* y, const double* z, const std::uint32_t* groups,
                            std::size_t group_count, const CellTransform& to_cells, const CellTable& table,
                            int min, std::uint32_t* found) {
  const auto columns = static_cast<std::uint32_t>(table.cells[0]),
             rows = static_cast<std::uint32_t>(table.cells[1]),
             layers = static_cast<std::uint32_t>(table.cells[2]);
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t at = kLanes * std::size_t{groups[g]};
    std::int32_t cell[3][kLanes];
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t lane = 0; lane < kLanes; lane += kWidth)
        store_coordinate(to_cells.row[axis], x + at + lane, y + at + lane, z + at + lane, cell[axis] + lane);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto i = static_cast<std::uint32_t>(cell[0][lane]), j = static_cast<std::uint32_t>(cell[1][lane]),
                 k = static_cast<std::uint32_t>(cell[2][lane]);
      if (!((i < columns) & (j < rows) & (k < layers))) continue;
      found[n] = static_cast<std::uint32_t>(at + lane);
      n += table.value[(k * rows + j) * columns + i] >= min ? 1 : 0;
    }
  }
  return n;
}

#endif

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
