// Lower bounds of the distance field of a tool over slabs of points, 6.2.2, at a pose and during a motion.
//
// The gradient of the field around a slab lies in a box, middle +- half per axis. So the field at an offset
// from the centre differs from that at the centre by middle . offset, give or take half . |offset|. The first
// part is small if the slab lies along the tool's surface.
#include "core/kernels/field_lanes.h"

#include <immintrin.h>

#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

constexpr double kRounding_m = 1e-8;  // more than the rounding of the bounds

// Slabs in the tool frame.
struct Slabs {
  Doubles3 c_T, n_T;
  Doubles radius, half;
};

inline Doubles3 placed(const PosedField& f, const Doubles3& p_W) {
  return rotated(f.R_TW, {p_W.x - f.p_W[0], p_W.y - f.p_W[1], p_W.z - f.p_W[2]});
}

struct BlockAlong {
  Counts block;
  Flags is_covered;  // the block's range covers `around` cells on both sides of the position
};
inline BlockAlong block_along(Doubles u, int cells, const SlopeTable& slopes) {
  const Counts cell = smaller(toward_zero(clamped(u, cells)), cells - 1);
  return {cell >> slopes.shift, (u >= slopes.around) & (u <= cells - slopes.around)};
}

// The box of the gradient, 1.
struct GradientBox {
  Doubles3 middle, half;
  Flags is_covered;
};
inline GradientBox gradient_box(const PosedField& f, const SlopeTable& slopes, const Doubles3& p_T) {
  const Divisor size(f.size);
  const BlockAlong x = block_along((p_T.x - f.origin_T[0]) / size, f.cells[0], slopes),
                   y = block_along((p_T.y - f.origin_T[1]) / size, f.cells[1], slopes),
                   z = block_along((p_T.z - f.origin_T[2]) / size, f.cells[2], slopes);
  const Counts block = x.block + slopes.blocks[0] * (y.block + slopes.blocks[1] * z.block);
  const TwoNodes along_x = two_nodes(slopes.range, 6 * block),
                 along_y = two_nodes(slopes.range + 2, 6 * block),
                 along_z = two_nodes(slopes.range + 4, 6 * block);
  const double scale = 0.5 / f.size;
  return {{scale * (along_x.second + along_x.first), scale * (along_y.second + along_y.first),
           scale * (along_z.second + along_z.first)},
          {scale * (along_x.second - along_x.first), scale * (along_y.second - along_y.first),
           scale * (along_z.second - along_z.first)},
          x.is_covered & y.is_covered & z.is_covered};
}

// Returns the extent of a slab along an axis; n: that coordinate of its normal.
// The root of 1 - n^2 is smaller than the first terms of its series.
inline Doubles extent_along(Doubles n, Doubles radius, Doubles half) {
  const Doubles squared = n * n;
  return radius * (1 - squared * (0.5 + 0.125 * squared)) + half * magnitude(n);
}

// Returns a lower bound of the field over slabs whose centres are moved by up to +- path from p_T, where the
// field is `distance`; minus infinity if the box of the gradient does not cover them.
[[gnu::always_inline]] inline Doubles least_over(const PosedField& f, const SlopeTable& slopes,
                                                 const Slabs& slabs, const Doubles3& p_T, Doubles distance,
                                                 const Doubles3& path) {
  const GradientBox g = gradient_box(f, slopes, p_T);
  const Doubles3 &n = slabs.n_T, &middle = g.middle;
  const Doubles3 extent{extent_along(n.x, slabs.radius, slabs.half) + magnitude(path.x),
                        extent_along(n.y, slabs.radius, slabs.half) + magnitude(path.y),
                        extent_along(n.z, slabs.radius, slabs.half) + magnitude(path.z)};
  const Doubles across = dot(middle, n);
  const Doubles in_plane = norm(middle - across * n);
  const Doubles lower = distance - slabs.radius * in_plane - slabs.half * magnitude(across) -
                        magnitude(dot(middle, path)) - dot(g.half, extent) - kRounding_m;
  const double covered = slopes.around * f.size * (1 - 1e-9);
  const Flags is_known = g.is_covered & (extent.x <= covered) & (extent.y <= covered) & (extent.z <= covered);
  return is_known ? lower : broadcast(-__builtin_inf());
}

// Stores the numbers of the flagged lanes. Returns their number.
inline std::size_t put_numbers(Flags flags, const std::uint32_t (&number)[kDoubles], std::uint32_t* found) {
  std::size_t count = 0;
  for (unsigned mask = mask_of(flags); mask != 0; mask &= mask - 1)
    found[count++] = number[__builtin_ctz(mask)];
  return count;
}

}  // namespace

std::size_t slabs_in_field(const SlabColumns& slabs, const std::uint32_t* groups, std::size_t group_count,
                           const PosedField& f, const SlopeTable& slopes, const SlabLimits& limits,
                           std::uint32_t* found, double* nearest) {
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t first = kLanes * std::size_t{groups[g]};
    for (std::size_t i = first; i < first + kLanes; i += kDoubles) {
      const SphereColumns& s = slabs.sphere;
      const Slabs here{placed(f, {load(s.x + i), load(s.y + i), load(s.z + i)}),
                       rotated(f.R_TW, {load(slabs.nx + i), load(slabs.ny + i), load(slabs.nz + i)}),
                       load(s.radius + i), load(slabs.half + i)};
      const Doubles distance = sample(f, here.c_T).distance;
      const Doubles ball = smaller(distance, broadcast(limits.trusted)) - limits.slope * here.radius;
      const Doubles slab = least_over(f, slopes, here, here.c_T, distance, Doubles3{});
      const Doubles lower = larger(ball - kRounding_m, slab);
      const Flags reached = ~(lower > limits.reach);
      if (!is_any(reached)) continue;
      std::uint32_t number[kDoubles];
      for (std::size_t lane = 0; lane < kDoubles; ++lane) number[lane] = static_cast<std::uint32_t>(i + lane);
      Packing(reached).put(lower, nearest + n);
      n += put_numbers(reached, number, found + n);
    }
  }
  return n;
}

namespace {

// Returns the lanes whose points are certain to keep way.touch during the whole motion, which is cut in
// `parts` equal parts. before: lower bounds of the distances before the motion.
[[gnu::always_inline]] inline Flags is_clear(const Slabs& slabs, Doubles before, const PosedField& f,
                                             const SlopeTable& slopes, const SlabWay& way, int parts) {
  const Doubles3 end_T = rotated(
      way.turned, slabs.c_T - Doubles3{broadcast(way.a_T[0]), broadcast(way.a_T[1]), broadcast(way.a_T[2])});
  const Doubles3 along_T = end_T - slabs.c_T;
  // The chords of the points differ from that of the centre by up to `spread`; the field on the curves is
  // lower than on the chords by up to `bend`, as in contact_list.cpp.
  const Doubles spread = way.turn * slabs.radius;
  const Doubles bend =
      way.slope / 8 * way.turn * (way.turn * (norm(slabs.c_T) + slabs.radius + way.shift) + 2 * way.shift);
  const Doubles needed = way.touch + bend + kRounding_m;
  const Flags is_short = before - way.slope * (norm(along_T) + spread) > needed;
  if (mask_of(is_short) == (1u << kDoubles) - 1) return is_short;
  Flags stays = ~Flags{};
  const Slabs wider{slabs.c_T, slabs.n_T, slabs.radius + spread, slabs.half + spread};
  const Doubles3 path = broadcast(0.5 / parts) * along_T;
  for (int part = 0; part < parts && is_any(stays); ++part) {
    const Doubles3 middle = slabs.c_T + broadcast((part + 0.5) / parts) * along_T;
    stays &= least_over(f, slopes, wider, middle, sample(f, middle).distance, path) > needed;
  }
  return is_short | stays;
}

// Returns the lanes none of whose points with a normal faces way.ahead_W.
inline Flags is_behind(const Doubles3& facing, Doubles deviation, const SlabWay& way) {
  const Doubles3 ahead{broadcast(way.ahead_W[0]), broadcast(way.ahead_W[1]), broadcast(way.ahead_W[2])};
  return dot(facing, ahead) - deviation * norm(ahead) > 0;
}

}  // namespace

std::size_t slabs_on_way(const SlabColumns& slabs, ChosenSlabs chosen, const PosedField& f,
                         const SlopeTable& slopes, const SlabWay& way, int parts, std::uint32_t* found) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < chosen.count; k += kDoubles) {
    std::uint32_t at[kDoubles];  // indices in the list
    for (std::size_t lane = 0; lane < kDoubles; ++lane)
      at[lane] = chosen.index[k + lane < chosen.count ? k + lane : k];
    const auto of = [&](const double* column) {
      Doubles a;
      for (int lane = 0; lane < kDoubles; ++lane) a[lane] = column[chosen.number[at[lane]]];
      return a;
    };
    const SphereColumns& s = slabs.sphere;
    const Slabs here{placed(f, {of(s.x), of(s.y), of(s.z)}),
                     rotated(f.R_TW, {of(slabs.nx), of(slabs.ny), of(slabs.nz)}), of(s.radius),
                     of(slabs.half)};
    Doubles before;
    for (int lane = 0; lane < kDoubles; ++lane) before[lane] = chosen.nearest[at[lane]];
    Flags may = lane_numbers() < static_cast<long>(chosen.count - k);
    may &=
        ~is_behind({of(slabs.facing[0]), of(slabs.facing[1]), of(slabs.facing[2])}, of(slabs.deviation), way);
    if (!is_any(may)) continue;
    n += put_numbers(may & ~is_clear(here, before - chosen.change, f, slopes, way, parts), at, found + n);
  }
  return n;
}

// Detection of the groups of points that can be near a tool, 6.2.2, by the distance of their bounding spheres
// from the tool. A sphere with its centre outside the grid is tested with two lower bounds of the distance:
// the distance to the grid's box, and the distance of the nearest cell minus the length of a path to it.

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
