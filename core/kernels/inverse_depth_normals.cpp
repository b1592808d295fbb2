// Normals, 6.2.1, by a fit that needs no eigenvectors. The inverse depth of a plane is an affine function of
// the pixel: 1 / z = A i + B j + C at i columns and j rows from the centre. The kernel computes 16, 8 or 4
// pixels of a row at a time.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/float_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

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

}  // namespace

void inverse_depth_normals(const RowBand& band, const PointPlanes& in, const PixelRays& rays,
                           const float step[2], const PointPlanes& out, const FitPlanes& fits) {
  const auto work = fits.a ? work_for<true>(band) : work_for<false>(band);
  for (int row = band.first; row < band.last; ++row) work(band, row, in, rays, step, out, fits);
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
