// The trilinear distance field of a tool at several positions at once. The operations are those of
// sample_field(), in the same order.
#pragma once

#include "core/kernels/lanes.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch {
namespace {

struct FieldLanes {
  Doubles distance;
  Doubles3 gradient_T;
  Flags is_known;  // false outside the grid; the other members then belong to the nearest position in it
  Counts cell;     // index of the cell; the first coordinate runs fastest
  Flags in_cell;   // also false on the last planes of the grid
};

inline Doubles clamped(Doubles u, double cells) {
  const Doubles above = u > 0 ? u : Doubles{};  // NaN becomes 0
  return above < cells ? above : broadcast(cells);
}

// The values at a node and at the next node along the first coordinate.
struct TwoNodes {
  Doubles first, second;
};
#if defined(__AVX512F__)
inline TwoNodes two_nodes(const float* node, Counts at) {
  // Two loads of each lane are faster than a gather instruction.
  const auto one = [&](int lane) {
    return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(node + at[lane])));
  };
  const __m128 a = _mm_unpacklo_ps(one(0), one(1)), b = _mm_unpacklo_ps(one(2), one(3)),
               c = _mm_unpacklo_ps(one(4), one(5)), d = _mm_unpacklo_ps(one(6), one(7));
  return {_mm512_cvtps_pd(_mm256_set_m128(_mm_movelh_ps(c, d), _mm_movelh_ps(a, b))),
          _mm512_cvtps_pd(_mm256_set_m128(_mm_movehl_ps(d, c), _mm_movehl_ps(b, a)))};
}
#else
inline __m128d two_nodes_of_one(const float* node) {
  return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(node))));
}
inline TwoNodes two_nodes(const float* node, Counts at) {
#if defined(__AVX2__)
  const __m256d even = _mm256_set_m128d(two_nodes_of_one(node + at[2]), two_nodes_of_one(node + at[0])),
                odd = _mm256_set_m128d(two_nodes_of_one(node + at[3]), two_nodes_of_one(node + at[1]));
  return {_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd)};
#else
  const __m128d even = two_nodes_of_one(node + at[0]), odd = two_nodes_of_one(node + at[1]);
  return {_mm_unpacklo_pd(even, odd), _mm_unpackhi_pd(even, odd)};
#endif
}
#endif

inline Counts smaller(Counts a, int b) {
  return a < b ? a : Counts{} + b;
}

inline FieldLanes sample(const PosedField& f, const Doubles3& p_T) {
  const Divisor size(f.size);
  const Doubles u = (p_T.x - f.origin_T[0]) / size, v = (p_T.y - f.origin_T[1]) / size,
                w = (p_T.z - f.origin_T[2]) / size;
  const Doubles in_u = clamped(u, f.cells[0]), in_v = clamped(v, f.cells[1]), in_w = clamped(w, f.cells[2]);
  const Counts a = smaller(toward_zero(in_u), f.cells[0] - 1), b = smaller(toward_zero(in_v), f.cells[1] - 1),
               c = smaller(toward_zero(in_w), f.cells[2] - 1);
  const Doubles x = in_u - as_doubles(a), y = in_v - as_doubles(b), z = in_w - as_doubles(c);
  const int row = f.cells[0] + 1, layer = row * (f.cells[1] + 1);
  const Counts n = a + row * b + layer * c;
  const TwoNodes n00 = two_nodes(f.node, n), n10 = two_nodes(f.node + row, n),
                 n01 = two_nodes(f.node + layer, n), n11 = two_nodes(f.node + layer + row, n);
  const Doubles d00 = n00.second - n00.first, d10 = n10.second - n10.first, d01 = n01.second - n01.first,
                d11 = n11.second - n11.first;
  const Doubles v00 = n00.first + x * d00, v10 = n10.first + x * d10, v01 = n01.first + x * d01,
                v11 = n11.first + x * d11;
  const Doubles v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
  const Doubles dx0 = d00 + y * (d10 - d00), dx1 = d01 + y * (d11 - d01);
  return {v0 + z * (v1 - v0),
          {(dx0 + z * (dx1 - dx0)) / size, ((v10 - v00) + z * ((v11 - v01) - (v10 - v00))) / size,
           (v1 - v0) / size},
          (in_u == u) & (in_v == v) & (in_w == w),
          a + f.cells[0] * (b + f.cells[1] * c),
          (in_u == u) & (in_v == v) & (in_w == w) & (u < f.cells[0]) & (v < f.cells[1]) & (w < f.cells[2])};
}

// Rotates a vector from world axes into those of the tool.
inline Doubles3 rotated(const double (&R)[3][3], const Doubles3& a) {
  return {R[0][0] * a.x + (R[0][1] * a.y + R[0][2] * a.z), R[1][0] * a.x + (R[1][1] * a.y + R[1][2] * a.z),
          R[2][0] * a.x + (R[2][1] * a.y + R[2][2] * a.z)};
}

// Points in the tool frame, and the field at them.
struct PositionsInField {
  Doubles3 p_T;
  FieldLanes at;
};
inline PositionsInField positions_at(const PointColumns& points, std::size_t i, const PosedField& f) {
  const Doubles3 way_W{load(points.x + i) - f.p_W[0], load(points.y + i) - f.p_W[1],
                       load(points.z + i) - f.p_W[2]};
  const Doubles3 p_T = rotated(f.R_TW, way_W);
  return {p_T, sample(f, p_T)};
}

// Disks of the points from index i on, in the tool frame: normals, radii, slopes of the field in their
// planes, and lower bounds of the distance of any position on them.
struct DisksInField {
  Doubles3 n_T;
  Doubles radius, extent, slope, lower;  // slope: NaN without a normal; lower: then the distance
};
inline DisksInField disks_at(const PointColumns& points, std::size_t i, double fraction, const PosedField& f,
                             const FieldLanes& at) {
  const Doubles3 n = rotated(f.R_TW, {load(points.nx + i), load(points.ny + i), load(points.nz + i)});
  const Doubles extent = load(points.extent + i), radius = fraction * load(points.spacing + i) + extent;
  const Doubles3& g = at.gradient_T;
  const Doubles slope = norm(g - dot(g, n) * n);
  const Flags has_normal = (n.x - n.x == 0) & (n.y - n.y == 0) & (n.z - n.z == 0);
  return {n, radius, extent, has_normal ? slope : broadcast(__builtin_nan("")),
          has_normal ? at.distance - radius * slope : at.distance};
}

// Does the same as cell_number() of contact_thinning.h.
inline Flags cell_along(Doubles x, double per_m) {
  return (Flags)(x * per_m - kAlmostHalf + kRoundsToWhole) & 0xfffff;
}
inline Flags cell_number(const Doubles3& p, double per_m) {
  return cell_along(p.x, per_m) << 40 | cell_along(p.y, per_m) << 20 | cell_along(p.z, per_m);
}

// Does the same as is_flat() of near_points.h; a NaN slope is not flat.
inline Flags is_flat(Doubles slope, Doubles radius, Doubles extent) {
  return (slope < disk_search::kFlatSlope) & ((extent == 0) | (slope * radius < disk_search::kFlatDepth_m));
}

}  // namespace
}  // namespace remote_touch
