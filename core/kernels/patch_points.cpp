// The points of a tracked patch. Positions are rounded to a grid on which the sums are exact, so that neither
// the order of the points nor the number of lanes matters.
#include "core/kernels/level.h"
#include "core/kernels/point_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

inline double rounded(double x) {
  return (x + kRoundsToPatchGrid) - kRoundsToPatchGrid;
}

// Adds the last two of three terms first, in the order in which Eigen adds them in the core.
inline double dot(const double a[3], double x, double y, double z) {
  return a[0] * x + (a[1] * y + a[2] * z);
}

inline double square(double x) {
  return x * x;
}

}  // namespace

// Computes the positions first, in a loop that the compiler vectorises. Then it stores every point; only
// points in the cylinder advance the end.
std::size_t points_of_patch(const PointsView& points, const PatchAxes& axes, const PatchColumns& to) {
  constexpr std::size_t kChunk = 64;
  double u[kChunk], v[kChunk], h[kChunk];
  std::uint64_t in[kChunk];
  const PatchAxes a = axes;
  const PatchColumns out = to;
  const double max_width = a.radius * a.radius;
  std::size_t n = 0;
  for (std::size_t done = 0; done < points.padded_count; done += kChunk) {
    const std::size_t left = points.padded_count - done, count = left < kChunk ? left : kChunk;
    const double *x = points.x + done, *y = points.y + done, *z = points.z + done;
#pragma omp simd
    for (std::size_t i = 0; i < count; ++i) {
      const double dx = (x[i] - a.origin[0]) / a.unit_m, dy = (y[i] - a.origin[1]) / a.unit_m,
                   dz = (z[i] - a.origin[2]) / a.unit_m;
      u[i] = rounded(dot(a.u, dx, dy, dz));
      v[i] = rounded(dot(a.v, dx, dy, dz));
      h[i] = rounded(dot(a.n, dx, dy, dz));
      in[i] = (u[i] * u[i] + v[i] * v[i] < max_width) & (__builtin_fabs(h[i]) <= a.half_height);
    }
    for (std::size_t i = 0; i < count; ++i) {
      out.u[n] = u[i], out.v[n] = v[i], out.h[n] = h[i];
      out.source[n] = static_cast<std::uint32_t>(done + i);
      n += in[i];
    }
  }
  return n;
}

// Computes the cells first, then interpolates the heights at their corners.
void heights_above(const PatchColumns& positions, std::size_t total, const HeightGrid& grid, double* above) {
  constexpr std::size_t kChunk = 64;
  double along[kChunk], across[kChunk];
  int at[kChunk];
  const HeightGrid g = grid;
  const int row = g.cells + 1;
  const double *low = g.corner, *high = low + row;
  for (std::size_t done = 0; done < total; done += kChunk) {
    const std::size_t left = total - done, count = left < kChunk ? left : kChunk;
    const double *u = positions.u + done, *v = positions.v + done, *h = positions.h + done;
#pragma omp simd
    for (std::size_t k = 0; k < count; ++k) {
      const double to_u = (u[k] + g.half) * g.per_unit, to_v = (v[k] + g.half) * g.per_unit;
      const double x = to_u < 0 ? 0 : to_u > g.last ? g.last : to_u;
      const double y = to_v < 0 ? 0 : to_v > g.last ? g.last : to_v;
      const int i = static_cast<int>(x), j = static_cast<int>(y);
      along[k] = x - i, across[k] = y - j, at[k] = j * row + i;
    }
#pragma omp simd
    for (std::size_t k = 0; k < count; ++k) {
      const double a = low[at[k]] + along[k] * (low[at[k] + 1] - low[at[k]]);
      const double b = high[at[k]] + along[k] * (high[at[k] + 1] - high[at[k]]);
      above[done + k] = h[k] - (a + across[k] * (b - a));
    }
  }
}

PlaneSums sums_near_plane(const PatchColumns& positions, std::size_t count, const double* height,
                          const NearPlane& near) {
  const NearPlane p = near;
  const double *us = positions.u, *vs = positions.v, max_width = p.reach * p.reach;
  double n = 0, su = 0, sv = 0, sh = 0, uu = 0, uv = 0, vv = 0, uh = 0, vh = 0;
#pragma omp simd reduction(+ : n, su, sv, sh, uu, uv, vv, uh, vh)
  for (std::size_t i = 0; i < count; ++i) {
    const double off = height[i] - p.height - p.slope_u * us[i] - p.slope_v * vs[i];
    const bool in = (__builtin_fabs(off) <= p.off) & (square(us[i] - p.u) + square(vs[i] - p.v) <= max_width);
    const double u = in ? us[i] : 0, v = in ? vs[i] : 0, h = in ? rounded(height[i]) : 0;
    n += in ? 1.0 : 0.0, su += u, sv += v, sh += h;
    uu += u * u, uv += u * v, vv += v * v, uh += u * h, vh += v * h;
  }
  return {n, su, sv, sh, uu, uv, vv, uh, vh};
}

void height_bins(const PatchColumns& positions, std::size_t count, const double* height, double u, double v,
                 double reach, const HeightBins& bins, std::int32_t* bin) {
  const double *us = positions.u, *vs = positions.v, max_width = reach * reach;
  const double half_range = bins.half_range, width = bins.width, max = bins.number;
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (height[i] + half_range) / width;
    const bool in = (place >= 0) & (place < max) & (square(us[i] - u) + square(vs[i] - v) <= max_width);
    bin[i] = static_cast<std::int32_t>(in ? place : max);
  }
}

// The products uu, uv and vv are rounded, so that products with them are exact.
QuadraticSums sums_of_quadratic(const PatchColumns& positions, const std::uint8_t* member, std::size_t count,
                                double radius) {
  const double *us = positions.u, *vs = positions.v, *hs = positions.h, max_width = radius * radius;
  double n = 0, u1 = 0, v1 = 0, u2 = 0, uv = 0, v2 = 0, u3 = 0, u2v = 0, uv2 = 0, v3 = 0;
#pragma omp simd reduction(+ : n, u1, v1, u2, uv, v2, u3, u2v, uv2, v3)
  for (std::size_t i = 0; i < count; ++i) {
    const bool in = (member[i] != 0) & (square(us[i]) + square(vs[i]) <= max_width);
    const double u = in ? us[i] : 0, v = in ? vs[i] : 0;
    const double uu = rounded(u * u), vv = rounded(v * v);
    n += in ? 1.0 : 0.0, u1 += u, v1 += v, u2 += uu, uv += rounded(u * v), v2 += vv;
    u3 += uu * u, u2v += uu * v, uv2 += vv * u, v3 += vv * v;
  }
  double u4 = 0, u3v = 0, u2v2 = 0, uv3 = 0, v4 = 0, h1 = 0, uh = 0, vh = 0, u2h = 0, uvh = 0, v2h = 0;
#pragma omp simd reduction(+ : u4, u3v, u2v2, uv3, v4, h1, uh, vh, u2h, uvh, v2h)
  for (std::size_t i = 0; i < count; ++i) {
    const bool in = (member[i] != 0) & (square(us[i]) + square(vs[i]) <= max_width);
    const double u = in ? us[i] : 0, v = in ? vs[i] : 0, h = in ? hs[i] : 0;
    const double uu = rounded(u * u), uxv = rounded(u * v), vv = rounded(v * v);
    u4 += uu * uu, u3v += uu * uxv, u2v2 += uu * vv, uv3 += uxv * vv, v4 += vv * vv;
    h1 += h, uh += u * h, vh += v * h, u2h += uu * h, uvh += uxv * h, v2h += vv * h;
  }
  return {{n, u1, v1, u2, uv, v2, u3, u2v, uv2, v3, u4, u3v, u2v2, uv3, v4}, {h1, uh, vh, u2h, uvh, v2h}};
}

const PatchKernels kPatchKernels = {.points_of_patch = points_of_patch,
                                    .heights_above = heights_above,
                                    .sums_near_plane = sums_near_plane,
                                    .height_bins = height_bins,
                                    .sums_of_quadratic = sums_of_quadratic};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
