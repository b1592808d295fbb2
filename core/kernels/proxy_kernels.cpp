// Query of the points near the proxy: one pass computes its state, its normal and the stiffness. The code is
// written in vectors, because compilers vectorise minima and 64-bit integers badly.

#include "core/kernels/point_kernels.h"

#include "core/kernels/lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

constexpr std::size_t kWidth = kDoubles;
using Lanes = Doubles;
using Bits __attribute__((vector_size(8 * kWidth))) = std::uint64_t;

inline std::uint64_t bits(double t) {
  return __builtin_bit_cast(std::uint64_t, t);
}

// Combines the lanes in halves. They stay in vectors, because each half would wait for the stores of the
// last.
template <class Vector, class Combine>
auto across(Vector v, Combine combine) {
  if constexpr (sizeof v == 64)
    return across(
        combine(__builtin_shufflevector(v, v, 0, 1, 2, 3), __builtin_shufflevector(v, v, 4, 5, 6, 7)),
        combine);
  else if constexpr (sizeof v == 32)
    return across(combine(__builtin_shufflevector(v, v, 0, 1), __builtin_shufflevector(v, v, 2, 3)), combine);
  else
    return combine(v[0], v[1]);
}
std::uint64_t total(const Bits& v) {
  return across(v, [](auto a, auto b) { return a + b; });
}
// Returns the sum of count terms t, given the sum of the bit patterns of t + M. The bit patterns in M's
// binade are integers that count steps of the grid. So the sum is exact, its order does not matter, and each
// term is t rounded to the grid.
double exact_sum(const Bits& sums, std::size_t count, double grid) {
  const std::uint64_t exponent = bits(grid) & 0x7FF0000000000000u;
  const double step = __builtin_bit_cast(double, exponent - (std::uint64_t{52} << 52));
  return static_cast<double>(static_cast<std::int64_t>(total(sums) - count * bits(grid))) * step;
}

// Computes the weight (4.2) of t = (r - r1) / (r3 - r1) in [0, 1].
inline Lanes wendland(Lanes t) {
  const Lanes q = 1.0 - t;
  return (q * q) * (q * q) * (4.0 * t + 1.0);
}

// Each root is computed seven vectors before it is used, because a root followed at once by a division that
// depends on it leaves the divider idle.
constexpr std::size_t kRing = 8, kAhead = 7;

// Computes the nearest point, the normal (4.1) with weights (4.2), and the sums of (5.8).
template <bool kRadius, bool kStiffness>
ContactQuery query_columns(const PointsView& points, const double p[3], const ProxyRegions& regions) {
  const Lanes zero = {}, tiny = zero + 1e-150;
  const Lanes px = zero + p[0], py = zero + p[1], pz = zero + p[2];
  const Lanes r1 = zero + regions.r1, r2 = zero + regions.r2, r3 = zero + regions.r3;
  const Lanes scale = zero + 1.0 / (regions.r3 - regions.r1), grid = zero + regions.sum_grid;
  const Lanes own = zero + regions.stiffness;
  const double stiffness_grid = regions.sum_grid * 1048576.0;  // k_s is at most 2^20 N/m
  const std::size_t vectors = points.padded_count / kWidth;

  Lanes ring[kRing];
  const auto measure = [&](std::size_t v) {
    const std::size_t i = v * kWidth;
    const Lanes dx = px - load(points.x + i), dy = py - load(points.y + i), dz = pz - load(points.z + i);
    ring[v % kRing] = root(dx * dx + dy * dy + dz * dz);
  };
  Lanes nearest = zero + __builtin_inf();
  Bits sx = {}, sy = {}, sz = {}, weights = {}, stiffness = {}, touching = {};
  for (std::size_t v = 0; v < kAhead && v < vectors; ++v) measure(v);
  for (std::size_t v = 0; v < vectors; ++v) {
    const std::size_t i = v * kWidth;
    const Lanes distance = ring[v % kRing];
    if (v + kAhead < vectors) measure(v + kAhead);
    const Lanes dx = px - load(points.x + i), dy = py - load(points.y + i), dz = pz - load(points.z + i);
    const Lanes r = kRadius ? distance - load(points.radius + i) : distance;
    // If r is r3, t is 1 up to rounding, and psi below 1e-60 is 0 on the grid.
    const Lanes psi = wendland((smaller(larger(r, r1), r3) - r1) * scale);
    const Lanes w = psi / larger(distance, tiny);  // a point at P adds 0 / 1e-150 = 0: it has no effect
    nearest = smaller(r, nearest);
    sx += (Bits)(dx * w + grid), sy += (Bits)(dy * w + grid), sz += (Bits)(dz * w + grid);
    touching -= (Bits)(r <= r2);  // a true lane is -1
    if (kStiffness) {
      weights += (Bits)(psi + grid);
      const Lanes k = load(points.stiffness + i);
      stiffness += (Bits)(psi * (k == k ? k : own) + stiffness_grid);
    }
  }
  const std::size_t count = points.padded_count;
  const double M = regions.sum_grid;
  // The first four numbers are written by one store, so that a wider load may read them at once.
  using Four __attribute__((vector_size(32))) = double;
  const Four first = {across(nearest, [](auto a, auto b) { return a < b ? a : b; }), exact_sum(sx, count, M),
                      exact_sum(sy, count, M), exact_sum(sz, count, M)};
  ContactQuery result;
  static_assert(offsetof(ContactQuery, weight_sum) == sizeof first);
  __builtin_memcpy(&result, &first, sizeof first);
  result.weight_sum = kStiffness ? exact_sum(weights, count, M) : 0.0;
  result.stiffness_sum = kStiffness ? exact_sum(stiffness, count, stiffness_grid) : 0.0;
  result.touching_count = static_cast<double>(static_cast<std::int64_t>(total(touching)));
  return result;
}

}  // namespace

ContactQuery contact_query(const PointsView& points, const double p[3], const ProxyRegions& regions) {
  if (points.radius)
    return points.stiffness ? query_columns<true, true>(points, p, regions)
                            : query_columns<true, false>(points, p, regions);
  return points.stiffness ? query_columns<false, true>(points, p, regions)
                          : query_columns<false, false>(points, p, regions);
}

// Step sizes along a direction: the distance to the first point, and the distance that leads out of all
// points.

namespace {

inline double larger(double a, double b) {
  return a > b ? a : b;
}
inline double smaller(double a, double b) {
  return a < b ? a : b;
}

// The root is computed in its perpendicular form: `along` is the foot of x on the ray, and the offset of x is
// computed from that foot, so nothing cancels if x is far away. The discriminant form would lose the shell of
// 2e-5 m between r1 and r2 there.
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
  // OpenMP starts the lanes of a minimum with the largest number, which is infinity for some compilers only.
  return first < __DBL_MAX__ ? first : __builtin_inf();
}

template <bool kRadius>
double exit_distance_columns(const PointsView& points, const double p[3], const double u[3], double reach,
                             double inner) {
  const double px = p[0], py = p[1], pz = p[2], ux = u[0], uy = u[1], uz = u[2];
  double max_length = 0.0;
  const double *x = points.x, *y = points.y, *z = points.z, *radius = points.radius;
#pragma omp simd reduction(max : max_length)
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const double ex = x[i] - px, ey = y[i] - py, ez = z[i] - pz;
    const double along = ex * ux + ey * uy + ez * uz;
    const double ox = ex - along * ux, oy = ey - along * uy, oz = ez - along * uz;
    const double rf = kRadius ? radius[i] : 0.0;
    const double r = reach + rf, limit = inner + rf;
    const double rest = r * r - (ox * ox + oy * oy + oz * oz);
    const bool entrenching = ex * ex + ey * ey + ez * ez < limit * limit;
    max_length = larger(entrenching ? along + __builtin_sqrt(larger(rest, 0.0)) : 0.0, max_length);
  }
  return max_length;
}

}  // namespace

double first_hit(const PointsView& points, const double p[3], const double direction[3], double reach) {
  return points.radius ? first_hit_columns<true>(points, p, direction, reach)
                       : first_hit_columns<false>(points, p, direction, reach);
}

double exit_distance(const PointsView& points, const double p[3], const double direction[3], double reach,
                     double inner) {
  return points.radius ? exit_distance_columns<true>(points, p, direction, reach, inner)
                       : exit_distance_columns<false>(points, p, direction, reach, inner);
}

const ProxyKernels kProxyKernels = {
    .contact_query = contact_query,
    .first_hit = first_hit,
    .exit_distance = exit_distance,
};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
