// Detection of the groups of points that can be near a tool, 6.2.2, by the distance of their bounding spheres
// from the tool. A sphere with its centre outside the grid is tested with two lower bounds of the distance:
// the distance to the grid's box, and the distance of the nearest cell minus the length of a path to it.
#include <immintrin.h>

#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

#if defined(__AVX512F__)

namespace {

// A coordinate of eight centres in cells, moved into the grid (NaN becomes 0), and the distance by which it
// was moved.
struct Along {
  __m256i cell;
  __m512d away;
};
inline Along coordinate(const double row[4], int cells, __m512d x, __m512d y, __m512d z) {
  const __m512d u = _mm512_add_pd(_mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(_mm512_set1_pd(row[0]), x),
                                                              _mm512_mul_pd(_mm512_set1_pd(row[1]), y)),
                                                _mm512_mul_pd(_mm512_set1_pd(row[2]), z)),
                                  _mm512_set1_pd(row[3]));
  const __m512d in = _mm512_min_pd(_mm512_max_pd(u, _mm512_setzero_pd()), _mm512_set1_pd(cells));
  return {_mm256_min_epi32(_mm512_cvttpd_epi32(in), _mm256_set1_epi32(cells - 1)),
          _mm512_abs_pd(_mm512_sub_pd(u, in))};
}

}  // namespace

std::size_t near_spheres(const SphereColumns& spheres, const std::uint32_t* groups, std::size_t group_count,
                         const CellTransform& to_cells, const CellTable& table, const NearnessCode& code,
                         std::uint32_t* found) {
  const __m256i columns = _mm256_set1_epi32(table.cells[0]), rows = _mm256_set1_epi32(table.cells[1]);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m512d per_unit = _mm512_set1_pd(1 / code.unit);
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t at = kLanes * std::size_t{groups[g]};
    const __m512d x = _mm512_loadu_pd(spheres.x + at), y = _mm512_loadu_pd(spheres.y + at),
                  z = _mm512_loadu_pd(spheres.z + at);
    const Along u = coordinate(to_cells.row[0], table.cells[0], x, y, z),
                v = coordinate(to_cells.row[1], table.cells[1], x, y, z),
                w = coordinate(to_cells.row[2], table.cells[2], x, y, z);
    const __m512d reach =
        _mm512_add_pd(_mm512_set1_pd(code.reach),
                      _mm512_mul_pd(_mm512_set1_pd(code.per_m), _mm512_loadu_pd(spheres.radius + at)));
    const __m512d squared =
        _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(u.away, u.away), _mm512_mul_pd(v.away, v.away)),
                      _mm512_mul_pd(w.away, w.away));
    __mmask8 in = _mm512_cmp_pd_mask(squared, _mm512_mul_pd(reach, reach), _CMP_NGT_UQ);
    if (in == 0) continue;
    const __m512d path_length = _mm512_add_pd(_mm512_add_pd(u.away, v.away), w.away);
    const __m512d min =
        _mm512_sub_pd(_mm512_set1_pd(code.zero), _mm512_mul_pd(_mm512_add_pd(reach, path_length), per_unit));
    const __m256i cell = _mm256_add_epi32(
        _mm256_mullo_epi32(_mm256_add_epi32(_mm256_mullo_epi32(w.cell, rows), v.cell), columns), u.cell);
    const __m256i words = _mm256_mmask_i32gather_epi32(_mm256_setzero_si256(), in, cell,
                                                       reinterpret_cast<const int*>(table.value), 1);
    const __m512d values = _mm512_cvtepi32_pd(_mm256_srai_epi32(_mm256_slli_epi32(words, 24), 24));
    in = _mm512_mask_cmp_pd_mask(in, values, min, _CMP_NLT_UQ);
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

inline double along(const double row[4], double x, double y, double z) {
  return row[0] * x + row[1] * y + row[2] * z + row[3];
}

// Moves a coordinate into the grid; NaN becomes 0.
inline double clamped(double u, double cells) {
  const double above = u > 0 ? u : 0;
  return above < cells ? above : cells;
}

inline double magnitude(double x) {
  return x < 0 ? -x : x;
}

}  // namespace

// Does the same in doubles: computes the coordinates of eight spheres at a time, then reads the cells one by
// one.
std::size_t near_spheres(const SphereColumns& spheres, const std::uint32_t* groups, std::size_t group_count,
                         const CellTransform& to_cells, const CellTable& table, const NearnessCode& code,
                         std::uint32_t* found) {
  const double columns = table.cells[0], rows = table.cells[1], layers = table.cells[2];
  const double per_unit = 1 / code.unit;
  constexpr double kNever = 1e9;  // larger than every value of a cell
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t at = kLanes * std::size_t{groups[g]};
    double in[3][kLanes], min[kLanes];
#pragma omp simd
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double x = spheres.x[at + lane], y = spheres.y[at + lane], z = spheres.z[at + lane];
      const double u = along(to_cells.row[0], x, y, z), v = along(to_cells.row[1], x, y, z),
                   w = along(to_cells.row[2], x, y, z);
      const double iu = clamped(u, columns), iv = clamped(v, rows), iw = clamped(w, layers);
      const double du = magnitude(u - iu), dv = magnitude(v - iv), dw = magnitude(w - iw);
      const double reach = code.reach + code.per_m * spheres.radius[at + lane];
      const double needed = code.zero - (reach + (du + dv + dw)) * per_unit;
      min[lane] = du * du + dv * dv + dw * dw > reach * reach ? kNever : needed;
      in[0][lane] = iu, in[1][lane] = iv, in[2][lane] = iw;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (min[lane] == kNever) continue;
      const int i = static_cast<int>(in[0][lane]), j = static_cast<int>(in[1][lane]),
                k = static_cast<int>(in[2][lane]);
      const int column = i < table.cells[0] ? i : table.cells[0] - 1,
                row = j < table.cells[1] ? j : table.cells[1] - 1,
                layer = k < table.cells[2] ? k : table.cells[2] - 1;
      found[n] = static_cast<std::uint32_t>(at + lane);
      n += table.value[(layer * table.cells[1] + row) * table.cells[0] + column] < min[lane] ? 0 : 1;
    }
  }
  return n;
}

#endif

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
