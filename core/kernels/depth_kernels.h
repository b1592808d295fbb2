// The depth pipeline, 6.2.1: from a depth image to points (7.1), the bilateral filter (7.2), normals, and
// into a cloud. Pixel (column, row) of a plane is plane[row * stride + column]; columns and rows count from
// the region that is asked for, so those of its border are negative. No alignment asked.
#pragma once

#include <cstddef>
#include <cstdint>

namespace remote_touch {

// Points in the camera frame, in a unit of length that suits their use. A pixel without a point has
// kNowhere as z: so far away that it has weight 0 for every other one.
struct PointPlanes {
  float* x;
  float* y;
  float* z;
  std::ptrdiff_t stride;
};

inline constexpr float kNowhere = 1e12f;

// What lies on the ray of pixel (u, v) is z * (ray_x[u], ray_y[v], 1).
struct PixelRays {
  const float* x;
  const float* y;
};

// Rows first .. last - 1 and columns 0 .. width - 1 are asked for. The planes have half more columns and rows
// on every side than the kernel reads for these, and kMaxLanes more columns to the right.
struct RowBand {
  int first, last;
  int width;
  int half;        // the window is 2 half + 1 pixels wide
  float* weights;  // room for weight_buffer_size(width, half)
};

inline constexpr int kMaxLanes = 16;

// A weight is the same from either point of a pair: computed for the upper one, kept for the lower. Of the
// pairs whose rows are j apart those of j + 1 rows are kept, each row with half more columns on either side.
constexpr std::ptrdiff_t weight_stride(int width, int half) {
  return (width + 4 * half + 2 * kMaxLanes) / kMaxLanes * kMaxLanes;
}
constexpr std::size_t weight_buffer_size(int width, int half) {
  return static_cast<std::size_t>(half * (half + 3) / 2 * (2 * half + 1) * weight_stride(width, half));
}

// One row of a depth image: its rays, its depths in metres, and what the filter adds to them, or null.
struct PixelRow {
  int width;
  const double* ray_x;  // as PixelRays, in double
  double ray_y;
  const double* depth_m;
  const float* change;
  double change_unit_m;
};

inline constexpr double kMaxDepth_m = 1000;  // what is farther away is not a depth

// Where a row of a cloud goes.
struct CloudRow {
  double* x;
  double* y;
  double* z;
  double* nx;
  double* ny;
  double* nz;
  std::uint8_t* valid;  // whether there is a point
};

// A point with its two neighbours is a plane only if the middle eigenvalue of their covariance is above this
// share of the sum of all: a line as wide as a hundredth of its length is none.
inline constexpr float kThinnest = 1e-4f;

// (7.2) takes squared distances in units of sigma_f^2 / (kFilterExponent / 2).
inline constexpr double kFilterExponent = 0.033102384734499175;

struct DepthKernels {
  // The points of one row in the camera frame, their z times scale.
  void (*depth_to_points)(const PixelRow&, double scale, const PointPlanes&);
  // (7.1), (7.2): what the filter adds to the z of every pixel, for points with lengths in units of
  // sigma_f / sqrt(kFilterExponent / 2).
  void (*filter_depth)(const RowBand&, const PointPlanes& points, float* change);
  // Unit normals towards the sensor, NaN where there is no plane. Lengths are in units of the radius; step is
  // (1 / fx, 1 / fy).
  void (*plane_normals)(const RowBand&, const PointPlanes& points, const PixelRays&, const float step[2],
                        const PointPlanes& normals);
  // One row into the cloud, m; X_WC row by row, three rows of four. z are those of the points the normals are
  // of.
  void (*points_to_cloud)(const PixelRow&, const double X_WC[12], const CloudRow&);
  void (*normals_to_cloud)(int width, const float* z, const PointPlanes& normals, const double X_WC[12],
                           const CloudRow&);
};

}  // namespace remote_touch
