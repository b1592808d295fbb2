// The depth pipeline, 6.2.1: points of a depth image, the bilateral filter (7.1), (7.2), normals, and their
// conversion into a cloud. Pixel (column, row) of a plane is plane[row * stride + column]; columns and rows
// count from the requested region, so those of its border can be negative. No alignment is required.
#pragma once

#include <cstddef>
#include <cstdint>

namespace remote_touch {

// Points in the camera frame, in a unit of length that each kernel defines. A pixel without a point has z =
// kNowhere. This is so far away that the weight of the pixel for every other point is 0.
struct PointPlanes {
  float* x;
  float* y;
  float* z;
  std::ptrdiff_t stride;
};

inline constexpr float kNowhere = 1e12f;

// The plane that was fitted to the window of each pixel: 1 / z = a i + b j + c at i columns and j rows from
// the pixel. error: weighted mean square of the relative errors; the relative error of a point is its
// distance from the plane along its ray, divided by the depth of the plane there. All four are NaN if there
// is no plane. Null pointers: the planes are not requested.
struct FitPlanes {
  float* a = nullptr;
  float* b = nullptr;
  float* c = nullptr;
  float* error = nullptr;
};

// The point at depth z on the ray of pixel (u, v) is z * (x[u], y[v], 1).
struct PixelRays {
  const float* x;
  const float* y;
};

// Requests rows first .. last - 1 and columns 0 .. width - 1. The planes extend by 2 half columns and rows on
// every side of these, and by kMaxLanes more columns to the right.
struct RowBand {
  int first, last;
  int width;
  int half;        // the window is 2 half + 1 pixels wide and high
  float* weights;  // work buffer of weight_buffer_size(width, half) values
  int step = 1;    // uses every step-th column and row of the window, from its centre; a divisor of half
};

inline constexpr int kMaxLanes = 16;

// The weight of a pair of points is symmetric: it is computed at the upper point and kept for the lower one.
// The weights of pairs that are j rows apart are kept for j + 1 rows, each row with `half` more columns on
// either side. A window with step 1 needs the largest buffer.
constexpr std::ptrdiff_t weight_stride(int width, int half) {
  return (width + 4 * half + 2 * kMaxLanes) / kMaxLanes * kMaxLanes;
}
constexpr std::size_t weight_buffer_size(int width, int half) {
  return static_cast<std::size_t>(half * (half + 3) / 2 * (2 * half + 1) * weight_stride(width, half));
}

// One row of a depth image: its rays, its depths in metres, and the changes of the depths by the filter
// (null: no filter).
struct PixelRow {
  int width;
  const double* ray_x;  // the same as in PixelRays, in double
  double ray_y;
  const double* depth_m;
  const float* change;
  double change_unit_m;
};

inline constexpr double kMaxDepth_m = 1000;  // a depth of this or more is a hole

// Destination of one row of a cloud.
struct CloudRow {
  double* x;
  double* y;
  double* z;
  double* nx;
  double* ny;
  double* nz;
  std::uint8_t* valid;  // 1 if there is a point, else 0
};

// The points of a window form a plane only if the middle eigenvalue of their covariance is above this
// fraction of the sum of all three. So a strip whose width is a hundredth of its length has no normal. The
// fit of the inverse depth compares the determinant of the covariance of the pixels with this fraction of its
// squared trace.
inline constexpr float kThinnest = 1e-4f;

// The unit of squared distances in (7.2) is sigma_f^2 / (kFilterExponent / 2).
inline constexpr double kFilterExponent = 0.033102384734499175;

struct DepthKernels {
  // Computes the points of one row in the camera frame, multiplied by scale.
  void (*depth_to_points)(const PixelRow&, double scale, const PointPlanes&);
  // Writes the change of the z of every pixel by the filter (7.1), (7.2). Lengths are in units of sigma_f /
  // sqrt(kFilterExponent / 2).
  void (*filter_depth)(const RowBand&, const PointPlanes& points, float* change);
  // Writes unit normals towards the sensor; they are NaN if there is no plane. Lengths are in units of the
  // radius; step is (1 / fx, 1 / fy).
  void (*plane_normals)(const RowBand&, const PointPlanes& points, const PixelRays&, const float step[2],
                        const PointPlanes& normals);
  // Writes unit normals from a fit of the inverse depth, with weights (1 - q^2)^2 of the distance q. The fits
  // have the same stride as the normals.
  void (*inverse_depth_normals)(const RowBand&, const PointPlanes& points, const PixelRays&,
                                const float step[2], const PointPlanes& normals, const FitPlanes& fits);
  // Selects the normals of one row. The candidates of each pixel are its own fit and those of the 8 pixels
  // that are `shift` columns or rows away. The error of such a pixel's fit is increased by the squared
  // relative error of the own point, and the fit with the smallest error is used. A fit other than the own
  // one is used only if its error is less than a quarter of the own error. z: depths of the points, with the
  // stride of the normals. The planes of normals and fits extend by `shift` columns and rows on every side,
  // and by kMaxLanes more columns.
  void (*sharp_normals)(int width, int shift, const float* z, const PointPlanes& normals,
                        const FitPlanes& fits, const PointPlanes& sharp);
  // Write one row into the cloud, m, world frame; X_WC is a row-major 3 x 4 matrix. z: depths of the points
  // that the normals belong to.
  void (*points_to_cloud)(const PixelRow&, const double X_WC[12], const CloudRow&);
  void (*normals_to_cloud)(int width, const float* z, const PointPlanes& normals, const double X_WC[12],
                           const CloudRow&);
};

}  // namespace remote_touch
