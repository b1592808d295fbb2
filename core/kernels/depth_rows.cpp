// Converts rows of pixels to planes of points, and these to rows of a cloud. The loops are plain, because
// every pixel is independent of the others.
#include "core/kernels/depth_kernels.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

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

}  // namespace

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

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
