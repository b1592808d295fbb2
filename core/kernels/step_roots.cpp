// Step sizes along a direction: the distance to the first point, and the distance that leads out of all
// points.
#include "core/kernels/level.h"
#include "core/kernels/proxy_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

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

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
