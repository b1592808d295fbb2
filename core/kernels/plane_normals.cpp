// Normals, 6.2.1: the plane of weighted total least squares through the neighbours of a pixel. The kernel
// computes 16, 8 or 4 pixels of a row at a time.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/float_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

// The neighbour that is i columns and j rows away has, relative to the centre's point, the sheared
// coordinates (i z / fx, j z / fy, dz): with rays a, p - p0 = (i z / fx + a_x dz, j z / fy + a_y dz, dz). So
// all moments follow from sums of w dz^n i^a j^b, in which i and j are numbers and not columns to be loaded.
struct Sums {
  Floats one = {}, i = {}, j = {}, ii = {}, ij = {}, jj = {};
};

// Sums over one row of the window.
struct RowSums {
  Floats one = {}, i = {}, ii = {};

  void add(float across, Floats left, Floats right) {
    const Floats both = left + right;
    one += both, i += across * (right - left), ii += (across * across) * both;
  }
};

inline void add(Sums& sums, const RowSums& row, float j) {
  sums.one += row.one, sums.i += row.i, sums.ii += row.ii;
  sums.j += j * row.one, sums.ij += j * row.i, sums.jj += (j * j) * row.one;
}

struct Symmetric {
  Floats xx, xy, xz, yy, yz, zz;
};

// Returns Wendland's psi(q) / 4, where q is the distance in units of the radius and psi(q) = (1 - q)^4 (4 q +
// 1), 0 beyond. The factor 1/4 has no effect, because it is the same for all points.
inline Floats wendland(Floats squared) {
  const Floats u = larger(1.0f - root(squared), Floats{});
  const Floats u2 = u * u;
  return (u2 * u2) * (1.25f - u);
}

// Returns the covariance in the camera frame from sums of w, w dz, w dz^2. The mean is subtracted in sheared
// coordinates.
inline Symmetric covariance(const Sums sums[3], Floats z, Floats ray_x, Floats ray_y, float step_x,
                            float step_y) {
  const Sums &w = sums[0], &k = sums[1], &l = sums[2];
  const Floats each = 1.0f / w.one;
  const auto product = [&](Floats of_w, Floats of_k, Floats of_l) {
    return (of_w * z + 2.0f * of_k) * z + of_l;
  };
  const Floats x = (w.i * z + k.i) * step_x * each, y = (w.j * z + k.j) * step_y * each, d = k.one * each;
  const Floats xx = product(w.ii, k.ii, l.ii) * (step_x * step_x) * each - x * x;
  const Floats xy = product(w.ij, k.ij, l.ij) * (step_x * step_y) * each - x * y;
  const Floats yy = product(w.jj, k.jj, l.jj) * (step_y * step_y) * each - y * y;
  const Floats xd = (k.i * z + l.i) * step_x * each - x * d, yd = (k.j * z + l.j) * step_y * each - y * d;
  const Floats dd = l.one * each - d * d;
  const Floats xz = xd + ray_x * dd, yz = yd + ray_y * dd;
  return {xx + ray_x * (xd + xz), xy + ray_x * yd + ray_y * xz, xz, yy + ray_y * (yd + yz), yz, dd};
}

struct Normal {
  Floats x, y, z;
};

inline Symmetric adjugate(const Symmetric& m) {
  return {m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy,
          m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.yz * m.xx, m.xx * m.yy - m.xy * m.xy};
}

// Returns the eigenvector of the smallest eigenvalue, towards the sensor. It is NaN if there is no point at
// depth z. It is also NaN if there is no plane, that is if the middle eigenvalue is below kThinnest of the
// sum, as for points on a line.
inline Normal smallest_eigenvector(Symmetric m, Floats z, Floats ray_x, Floats ray_y) {
  const Floats scale = 1.0f / (m.xx + m.yy + m.zz);
  m = {m.xx * scale, m.xy * scale, m.xz * scale, m.yy * scale, m.yz * scale, m.zz * scale};
  // Laguerre's method computes the smallest root of f = t^3 - t^2 + c1 t - c0, starting at 0. All three roots
  // are real, so the steps never pass the smallest one. They converge cubically, and still fast if two roots
  // nearly coincide.
  const Symmetric a = adjugate(m);
  const Floats c1 = a.xx + a.yy + a.zz, c0 = m.xx * a.xx + m.xy * a.xy + m.xz * a.xz;
  Floats t = {};
  for (int step = 0; step < 4; ++step) {
    const Floats f = ((t - 1.0f) * t + c1) * t - c0, slope = (3.0f * t - 2.0f) * t + c1;
    const Floats bend = 6.0f * t - 2.0f;
    t -= 3.0f * f / (slope + root(larger(4.0f * (slope * slope) - 6.0f * (f * bend), Floats{})));
  }
  // Each column of the adjugate of m - t is the eigenvector multiplied by one of its components. The column
  // with the largest factor is used.
  const Symmetric b = adjugate({m.xx - t, m.xy, m.xz, m.yy - t, m.yz, m.zz - t});
  const auto x_max = (b.xx >= b.yy) & (b.xx >= b.zz), y_max = b.yy >= b.zz;
  Normal n = {y_max ? b.xy : b.xz, y_max ? b.yy : b.yz, y_max ? b.yz : b.zz};
  n = {x_max ? b.xx : n.x, x_max ? b.xy : n.y, x_max ? b.xz : n.z};
  const Floats length = root(n.x * n.x + n.y * n.y + n.z * n.z);
  const Floats away = n.x * ray_x + n.y * ray_y + n.z;
  const Floats factor = (away > Floats{} ? Floats{} - 1.0f : Floats{} + 1.0f) / length;
  const auto plane = (z < Floats{} + 0.5f * kNowhere) & (c1 > Floats{} + kThinnest);
  // All three components are the same NaN: a product of two NaNs would keep the one that the compiler
  // chooses.
  const Floats none = Floats{} + __builtin_nanf("");
  return {plane ? n.x * factor : none, plane ? n.y * factor : none, plane ? n.z * factor : none};
}

// kTaps: pixels of the window that are used on each side of its centre, or 0 if their number is not a
// constant.
template <int kTaps, int kStep>
void normals_of_row(const RowBand& band, int row, bool only_weights, const PointPlanes in,
                    const PixelRays& rays, const float step[2], const PointPlanes out) {
  const int stride = kTaps ? kStep : band.step, half = kTaps ? kTaps * kStep : band.half;
  const int taps = kTaps ? kTaps : half / stride, end = band.width + half;
  const PairWeights weights(band.weights, band.width, half, stride, row);
  for (int u = -half; u < end; u += kFloats) {
    const std::ptrdiff_t here = row * in.stride + u;
    const Floats x0 = load(in.x + here), y0 = load(in.y + here), z0 = load(in.z + here);
    const auto depth = [&](int j, int i) { return load(in.z + here + stride * (j * in.stride + i)) - z0; };
    const auto weight = [&](int j, int i) {
      const std::ptrdiff_t at = here + stride * (j * in.stride + i);
      const Floats dx = load(in.x + at) - x0, dy = load(in.y + at) - y0, dz = load(in.z + at) - z0;
      return wendland(dx * dx + dy * dy + dz * dz);
    };
    const auto fresh = [&](int j, int i) {
      const Floats psi = weight(j, i);
      store(weights.fresh(j, i) + u, psi);
      return psi;
    };
    const auto kept = [&](int j, int i) { return load(weights.kept(-j, -i) + u + stride * i); };
    if (only_weights) {
      for (int j = 1; j <= taps; ++j) {
        fresh(j, 0);
        for_each_step<kTaps>(taps, [&](int i) { fresh(j, -i), fresh(j, i); });
      }
      continue;
    }
    Sums sums[3];
    const auto add_row = [&](int j, Floats middle, const auto& psi) __attribute__((always_inline)) {
      const Floats dz = depth(j, 0), k0 = middle * dz;
      RowSums w{middle, {}, {}}, k{k0, {}, {}}, l{k0 * dz, {}, {}};
      for_each_step<kTaps>(
          taps, [&](int i) __attribute__((always_inline)) {
            const float across = static_cast<float>(stride * i);
            const Floats left = psi(j, -i), right = psi(j, i);
            const Floats dz_left = depth(j, -i), dz_right = depth(j, i);
            const Floats k_left = left * dz_left, k_right = right * dz_right;
            w.add(across, left, right), k.add(across, k_left, k_right);
            l.add(across, k_left * dz_left, k_right * dz_right);
          });
      const float down = static_cast<float>(stride * j);
      add(sums[0], w, down), add(sums[1], k, down), add(sums[2], l, down);
    };
    add_row(0, Floats{} + 0.25f, weight);
    for (int j = 1; j <= taps; ++j) add_row(j, fresh(j, 0), fresh);
    for (int j = 1; j <= taps; ++j) add_row(-j, kept(-j, 0), kept);
    const Floats ray_x = load(rays.x + u), ray_y = Floats{} + rays.y[row];
    const Symmetric m = covariance(sums, z0, ray_x, ray_y, step[0], step[1]);
    const Normal n = smallest_eigenvector(m, z0, ray_x, ray_y);
    const std::ptrdiff_t to = row * out.stride + u;
    store(out.x + to, n.x), store(out.y + to, n.y), store(out.z + to, n.z);
  }
}

}  // namespace

void plane_normals(const RowBand& band, const PointPlanes& in, const PixelRays& rays, const float step[2],
                   const PointPlanes& out) {
  const auto known = [&](int half, int stride) { return band.half == half && band.step == stride; };
  const auto work = known(4, 1)   ? normals_of_row<4, 1>
                    : known(4, 2) ? normals_of_row<2, 2>
                                  : normals_of_row<0, 0>;
  for (int row = band.first - band.half; row < band.last; ++row)
    work(band, row, row < band.first, in, rays, step, out);
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
