// The kernels of the depth pipeline. The spatial bilateral filter (7.1), (7.2) processes 16, 8 or 4 pixels of
// a row at a time. It sums differences to the depth of the pixel itself, so that the relative error of single
// precision, 1e-7, applies to them and not to the depths.

#include "core/kernels/depth_kernels.h"

#include "core/kernels/lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {
namespace {

struct Point {
  Floats x, y, z;
};

inline Point point(const PointPlanes& planes, std::ptrdiff_t at) {
  return {load(planes.x + at), load(planes.y + at), load(planes.z + at)};
}

// Computes (7.2) from the squared distance s in filter units: e^-t with t = s / kFilterExponent, approximated
// by the 16th power of a cubic that falls to exactly 0 at t = 27.4. The cubic is the minimax fit of the
// weight: the error is below 8e-6 for every t, rounding included.
inline Floats gaussian(Floats s) {
  constexpr float kEnd = 0.9083625722727604f, kCentre = 0.4332450600460519f, kLift = 0.9131807121233679f;
  const Floats y = smaller(s, Floats{} + kEnd), from_centre = y - kCentre;
  const Floats p = (kEnd - y) * (from_centre * from_centre + kLift);
  const Floats p2 = p * p, p4 = p2 * p2, p8 = p4 * p4;
  return p8 * p8;
}

template <int kHalf>
void filter_row(const RowBand& band, int row, bool only_weights, const PointPlanes in, float* change) {
  const int half = kHalf ? kHalf : band.half, end = band.width + half;
  const PairWeights weights(band.weights, band.width, half, 1, row);
  for (int u = -half; u < end; u += kFloats) {
    const std::ptrdiff_t here = row * in.stride + u;
    const Point p0 = point(in, here);
    Floats sum = {}, total = Floats{} + 1.0f;  // weight of the point itself
    const auto pair = [&](int below, int across) {
      const Point p = point(in, here + below * in.stride + across);
      const Floats dx = p.x - p0.x, dy = p.y - p0.y, dz = p.z - p0.z;
      const Floats phi = gaussian(dx * dx + dy * dy + dz * dz);
      sum += phi * dz, total += phi;
      return phi;
    };
    const auto fresh = [&](int j, int i) { store(weights.fresh(j, i) + u, pair(j, i)); };
    const auto kept = [&](int j, int i) {
      const Floats phi = load(weights.kept(j, -i) + u + i);
      sum += phi * (load(in.z + here - j * in.stride + i) - p0.z), total += phi;
    };
    for (int j = 1; j <= half; ++j) {
      fresh(j, 0);
      for_each_step<kHalf>(half, [&](int i) { fresh(j, -i), fresh(j, i); });
    }
    if (only_weights) continue;
    for_each_step<kHalf>(half, [&](int i) { pair(0, -i), pair(0, i); });
    for (int j = 1; j <= half; ++j) {
      kept(j, 0);
      for_each_step<kHalf>(half, [&](int i) { kept(j, -i), kept(j, i); });
    }
    store(change + here, sum / total);
  }
}

// Returns true if the depth is a measurement: in front of the camera, below kMaxDepth_m and not NaN.
inline bool measured(double z_m) {
  return (z_m > 0) & (z_m < kMaxDepth_m);
}

template <bool kFiltered>
void points_of_row(const PixelRow& row, double scale, const PointPlanes& out) {
  const float ray_y = static_cast<float>(row.ray_y);
#pragma omp simd
  for (int u = 0; u < row.width; ++u) {
    const double depth = row.depth_m[u];
    const double z_m = kFiltered ? depth + row.change_unit_m * row.change[u] : depth;
    const float z = measured(depth) ? static_cast<float>(z_m * scale) : kNowhere;
    out.x[u] = z * static_cast<float>(row.ray_x[u]), out.y[u] = z * ray_y, out.z[u] = z;
  }
}

template <bool kFiltered>
void place_points(const PixelRow& row, const double X_WC[12], const CloudRow& out) {
  const double* const X = X_WC;
  const double ray_y = row.ray_y;
  constexpr double kNone = __builtin_nan("");
#pragma omp simd
  for (int u = 0; u < row.width; ++u) {
    const double depth = row.depth_m[u];
    const double filtered = kFiltered ? depth + row.change_unit_m * row.change[u] : depth;
    const double z = measured(depth) ? filtered : kNone;
    const double x = row.ray_x[u] * z, y = ray_y * z;
    out.x[u] = X[0] * x + X[1] * y + X[2] * z + X[3];
    out.y[u] = X[4] * x + X[5] * y + X[6] * z + X[7];
    out.z[u] = X[8] * x + X[9] * y + X[10] * z + X[11];
  }
}

// Weighted least squares of z (A i + B j + c) = -dz / z0, with C = 1 / z0 + c. The equation of the plane is
// multiplied by z, so that no division by the depth of a neighbour is needed. Its value at the centre is
// subtracted, so that nothing cancels. The sums are those of w z^2 {1, i, j, i^2, i j, j^2}, of w z dz {1, i,
// j}, and of w dz^2.
struct Sums {
  Floats one = {}, i = {}, j = {}, ii = {}, ij = {}, jj = {};
  Floats k = {}, ki = {}, kj = {}, kk = {};
};

// Returns the weight (1 - q^2)^2, where q is the distance in units of the radius. It falls smoothly to 0 at
// the radius and needs no root.
inline Floats biweight(Floats squared) {
  const Floats u = larger(1.0f - squared, Floats{});
  return u * u;
}

struct Normal {
  Floats x, y, z;
  Floats a, b, c, error;  // plane and error of the fit
};

template <bool kFits>
inline Normal normal(const Sums& sums, Floats z0, Floats ray_x, Floats ray_y, const float step[2]) {
  const Floats each = 1.0f / sums.one, minus = Floats{} - 1.0f / z0;
  const Floats i = sums.i * each, j = sums.j * each, k = sums.k * each * minus;
  const Floats ii = sums.ii * each - i * i, ij = sums.ij * each - i * j, jj = sums.jj * each - j * j;
  const Floats ki = sums.ki * each * minus - k * i, kj = sums.kj * each * minus - k * j;
  const Floats spread = ii + jj, minor = ii * jj - ij * ij;  // a, b, centre: multiplied by minor
  const Floats a = ki * jj - kj * ij, b = kj * ii - ki * ij;
  const Floats centre = minor * (k - minus) - a * i - b * j;
  Normal n = {};
  n.x = a / step[0], n.y = b / step[1];
  n.z = centre - ray_x * n.x - ray_y * n.y;
  const Floats length = root(n.x * n.x + n.y * n.y + n.z * n.z);
  const Floats factor = (centre > Floats{} ? Floats{} - 1.0f : Floats{} + 1.0f) / length;
  const auto plane = (z0 < Floats{} + 0.5f * kNowhere) & (minor > kThinnest * (spread * spread));
  const Floats none = Floats{} + __builtin_nanf("");
  n.x = plane ? n.x * factor : none, n.y = plane ? n.y * factor : none, n.z = plane ? n.z * factor : none;
  if constexpr (kFits) {
    // The minimum of the sum of squares is the sum of all w (dz / z0)^2 minus the part that the fit explains.
    // Multiplied by z0^2 and divided by the sum of w z^2, it is the mean square of the relative errors.
    const Floats once = 1.0f / minor;
    n.a = plane ? a * once : none, n.b = plane ? b * once : none, n.c = plane ? centre * once : none;
    const Floats explained = n.a * sums.ki + n.b * sums.kj + (n.c + minus) * sums.k;
    n.error = larger((sums.kk + z0 * explained) * each, Floats{});
    n.error = plane ? n.error : none;
  }
  return n;
}

template <int kTaps, int kStep, bool kFits>
void normals_of_row(const RowBand& band, int row, const PointPlanes in, const PixelRays& rays,
                    const float step[2], const PointPlanes out, const FitPlanes fits) {
  const int stride = kTaps ? kStep : band.step, taps = kTaps ? kTaps : band.half / stride;
  for (int u = 0; u < band.width; u += kFloats) {
    const std::ptrdiff_t here = row * in.stride + u;
    const Floats x0 = load(in.x + here), y0 = load(in.y + here), z0 = load(in.z + here);
    Sums sums;
    const auto add_row = [&](int j) __attribute__((always_inline)) {
      Floats one = {}, i_sum = {}, ii = {}, k = {}, ki = {}, kk = {};
      const auto tap = [&](int i, Floats& w, Floats& r) __attribute__((always_inline)) {
        const std::ptrdiff_t at = here + stride * (j * in.stride + i);
        const Floats z = load(in.z + at), dx = load(in.x + at) - x0, dy = load(in.y + at) - y0, dz = z - z0;
        const Floats weight = biweight(dx * dx + dy * dy + dz * dz), wz = weight * z;
        w = wz * z, r = wz * dz;
        if constexpr (kFits) kk += weight * dz * dz;
      };
      Floats w, r, w_right, r_right;
      tap(0, one, k);
      for_each_step<kTaps>(
          taps, [&](int i) __attribute__((always_inline)) {
            tap(-i, w, r), tap(i, w_right, r_right);
            const float across = static_cast<float>(stride * i);
            const Floats both = w + w_right;
            one += both, i_sum += across * (w_right - w), ii += (across * across) * both;
            k += r + r_right, ki += across * (r_right - r);
          });
      const float down = static_cast<float>(stride * j);
      sums.one += one, sums.i += i_sum, sums.ii += ii, sums.k += k, sums.ki += ki;
      if constexpr (kFits) sums.kk += kk;
      sums.j += down * one, sums.ij += down * i_sum, sums.jj += (down * down) * one, sums.kj += down * k;
    };
    add_row(0);
    for_each_step<kTaps>(
        taps, [&](int j) __attribute__((always_inline)) { add_row(-j), add_row(j); });
    const Normal n = normal<kFits>(sums, z0, load(rays.x + u), Floats{} + rays.y[row], step);
    const std::ptrdiff_t to = row * out.stride + u;
    store(out.x + to, n.x), store(out.y + to, n.y), store(out.z + to, n.z);
    if constexpr (kFits) {
      store(fits.a + to, n.a), store(fits.b + to, n.b);
      store(fits.c + to, n.c), store(fits.error + to, n.error);
    }
  }
}

template <bool kFits>
auto work_for(const RowBand& band) {
  return band.half == 4 && band.step == 2 ? normals_of_row<2, 2, kFits> : normals_of_row<0, 0, kFits>;
}

// The limit of the ratio of two mean square errors. Noise alone seldom makes the error of one window a
// quarter of another's, and on a ball the errors are similar.
constexpr float kClearlyLess = 0.25f;

struct Choice {
  Floats error, x, y, z;
};

// The neighbour that is i columns and j rows away has, relative to the centre's point, the sheared
// coordinates (i z / fx, j z / fy, dz): with rays a, p - p0 = (i z / fx + a_x dz, j z / fy + a_y dz, dz). So
// all moments follow from sums of w dz^n i^a j^b, in which i and j are numbers and not columns to be loaded.
struct PlaneSums {
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

inline void add(PlaneSums& sums, const RowSums& row, float j) {
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
inline Symmetric covariance(const PlaneSums sums[3], Floats z, Floats ray_x, Floats ray_y, float step_x,
                            float step_y) {
  const PlaneSums &w = sums[0], &k = sums[1], &l = sums[2];
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

struct PlaneNormal {
  Floats x, y, z;
};

inline Symmetric adjugate(const Symmetric& m) {
  return {m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy,
          m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.yz * m.xx, m.xx * m.yy - m.xy * m.xy};
}

// Returns the eigenvector of the smallest eigenvalue, towards the sensor. It is NaN if there is no point at
// depth z. It is also NaN if there is no plane, that is if the middle eigenvalue is below kThinnest of the
// sum, as for points on a line.
inline PlaneNormal smallest_eigenvector(Symmetric m, Floats z, Floats ray_x, Floats ray_y) {
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
  PlaneNormal n = {y_max ? b.xy : b.xz, y_max ? b.yy : b.yz, y_max ? b.yz : b.zz};
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
    PlaneSums sums[3];
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
    const PlaneNormal n = smallest_eigenvector(m, z0, ray_x, ray_y);
    const std::ptrdiff_t to = row * out.stride + u;
    store(out.x + to, n.x), store(out.y + to, n.y), store(out.z + to, n.z);
  }
}

}  // namespace

void filter_depth(const RowBand& band, const PointPlanes& in, float* change) {
  const auto work = band.half == 4   ? filter_row<4>
                    : band.half == 2 ? filter_row<2>
                    : band.half == 1 ? filter_row<1>
                                     : filter_row<0>;
  for (int row = band.first - band.half; row < band.last; ++row)
    work(band, row, row < band.first, in, change);
}

// Converts rows of pixels to planes of points, and these to rows of a cloud. The loops are plain, because
// every pixel is independent of the others.

void depth_to_points(const PixelRow& row, double scale, const PointPlanes& out) {
  (row.change ? points_of_row<true> : points_of_row<false>)(row, scale, out);
}

void points_to_cloud(const PixelRow& row, const double X_WC[12], const CloudRow& out) {
  (row.change ? place_points<true> : place_points<false>)(row, X_WC, out);
}

// The normals have unit length in single precision. One step of Newton's method gives them unit length in
// double precision.
void normals_to_cloud(int width, const float* z, const PointPlanes& normals, const double X_WC[12],
                      const CloudRow& out) {
  const double* const X = X_WC;
#pragma omp simd
  for (int u = 0; u < width; ++u) out.valid[u] = z[u] < 0.5f * kNowhere;
#pragma omp simd
  for (int u = 0; u < width; ++u) {
    const double x = normals.x[u], y = normals.y[u], along = normals.z[u];
    const double one = 1.5 - 0.5 * (x * x + y * y + along * along);
    out.nx[u] = (X[0] * x + X[1] * y + X[2] * along) * one;
    out.ny[u] = (X[4] * x + X[5] * y + X[6] * along) * one;
    out.nz[u] = (X[8] * x + X[9] * y + X[10] * along) * one;
  }
}

// Normals, 6.2.1, by a fit that needs no eigenvectors. The inverse depth of a plane is an affine function of
// the pixel: 1 / z = A i + B j + C at i columns and j rows from the centre. The kernel computes 16, 8 or 4
// pixels of a row at a time.

void inverse_depth_normals(const RowBand& band, const PointPlanes& in, const PixelRays& rays,
                           const float step[2], const PointPlanes& out, const FitPlanes& fits) {
  const auto work = fits.a ? work_for<true>(band) : work_for<false>(band);
  for (int row = band.first; row < band.last; ++row) work(band, row, in, rays, step, out, fits);
}

// Normals of pixels whose own window extends over an edge, taken from windows beside the pixel: the planes on
// both sides of a crease or an occlusion edge are fitted best by windows that end there. A choice among
// shifted windows has been used to keep edges in images since Kuwahara, Hachimura, Eiho and Kinoshita (1976).
// The kernel computes 16, 8 or 4 pixels of a row at a time.

void sharp_normals(int width, int shift, const float* z, const PointPlanes& normals, const FitPlanes& fits,
                   const PointPlanes& sharp) {
  for (int u = 0; u < width; u += kFloats) {
    const Floats z0 = load(z + u);
    // An error below 1 means that the plane is in front of the camera, so that its normal points towards the
    // sensor. A pixel without a plane of its own keeps NaN, because no error is less than NaN.
    Choice best = {smaller(Floats{} + 1.0f, kClearlyLess * load(fits.error + u)), load(normals.x + u),
                   load(normals.y + u), load(normals.z + u)};
    const auto offer = [&](int i, int j) __attribute__((always_inline)) {
      const std::ptrdiff_t at = u + shift * (j * normals.stride + i);
      const Floats here = load(fits.c + at) - static_cast<float>(shift * i) * load(fits.a + at) -
                          static_cast<float>(shift * j) * load(fits.b + at);
      const Floats beside = z0 * here - 1.0f, error = load(fits.error + at) + beside * beside;
      const auto is_better = error < best.error;  // false if there is no plane
      best = {is_better ? error : best.error, is_better ? load(normals.x + at) : best.x,
              is_better ? load(normals.y + at) : best.y, is_better ? load(normals.z + at) : best.z};
    };
    offer(-1, -1), offer(0, -1), offer(1, -1), offer(-1, 0), offer(1, 0), offer(-1, 1), offer(0, 1),
        offer(1, 1);
    store(sharp.x + u, best.x), store(sharp.y + u, best.y), store(sharp.z + u, best.z);
  }
}

// Normals, 6.2.1: the plane of weighted total least squares through the neighbours of a pixel. The kernel
// computes 16, 8 or 4 pixels of a row at a time.

void plane_normals(const RowBand& band, const PointPlanes& in, const PixelRays& rays, const float step[2],
                   const PointPlanes& out) {
  const auto known = [&](int half, int stride) { return band.half == half && band.step == stride; };
  const auto work = known(4, 1)   ? normals_of_row<4, 1>
                    : known(4, 2) ? normals_of_row<2, 2>
                                  : normals_of_row<0, 0>;
  for (int row = band.first - band.half; row < band.last; ++row)
    work(band, row, row < band.first, in, rays, step, out);
}

const DepthKernels kDepthKernels = {
    .depth_to_points = depth_to_points,
    .filter_depth = filter_depth,
    .plane_normals = plane_normals,
    .inverse_depth_normals = inverse_depth_normals,
    .sharp_normals = sharp_normals,
    .points_to_cloud = points_to_cloud,
    .normals_to_cloud = normals_to_cloud,
};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
