// From a depth frame to a cloud with normals: filter (7.1), (7.2) and the normals of 6.2.1.
//
// Depths are filtered spatially: v0' = sum v_k phi(k) / sum phi(k) over a window of pixels, with phi(k) =
// exp(-|p_k - p_0|^2 / (2 sigma_f^2)) of Cartesian distances between the points as measured. Then the points
// are unprojected again, and a plane of weighted total least squares through the filtered neighbours of each
// gives its normal: weights psi of (4.2) from 1 at the point to 0 at the radius, eigenvector of the smallest
// eigenvalue of the covariance, towards the sensor.
//
// A depth that is NaN, infinite, zero, negative, or 1 km and more is a hole: no point, and no influence.
// Computed in single precision in the camera frame: normals are within 0.05 degrees of those in double. The
// same bits on every machine, for any number of threads, and for a rectangle as for the whole frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/cloud/camera.h"
#include "core/cloud/point_cloud.h"
#include "core/kernels/depth_kernels.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// How a normal is found: the plane of total least squares, or the faster fit of the inverse depth, which is
// an affine function of the pixel on every plane, with weights (1 - q^2)^2 for psi(q).
enum class NormalFit { total_least_squares, inverse_depth };

struct DepthPipelineSettings {
  bool filter = true;
  int filter_window = 9;
  double sigma_f_m = 0.025;
  int normal_window = 9;
  double normal_radius_m = 0.014;
  int normal_step = 1;
  NormalFit normal_fit = NormalFit::total_least_squares;
};

// The fast setting: a quarter to a third of the default's time. Filter and steps together use every pixel of
// 11 x 11.
inline constexpr DepthPipelineSettings kFastDepthPipeline{
    true, 3, 0.025, 9, 0.02, 2, NormalFit::inverse_depth};

Parameters parameters(DepthPipelineSettings& s);
std::string validate(const DepthPipelineSettings& s);

struct PixelRectangle {
  int left = 0, top = 0;
  int width = 0, height = 0;
};

// Reuses its memory: after the first frame of a size nothing is allocated, if the caller passes the same
// cloud again. Throws std::invalid_argument if sizes do not match, and for settings that validate() refuses.
class DepthPipeline {
 public:
  DepthPipeline(const DepthPipelineSettings& settings, const Kernels& kernels);

  // X_WC is the registration of the camera in the base frame. cloud becomes points, normals and image layout,
  // without other columns; NaN where there is no point, or no plane for a normal.
  void process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC,
               PointCloud& cloud);
  PointCloud process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC);
  // Only these pixels, at the cost of these: bit for bit as they are in the whole frame. The image layout is
  // that of a camera with these pixels alone. pre: the rectangle lies in the image.
  void process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC,
               const PixelRectangle& rectangle, PointCloud& cloud);
  // An organised cloud, in place: its depth image is taken from the points, all other columns stay.
  void process(PointCloud& cloud);

  // 1 for each pixel of the last cloud that has a point, with or without a normal; else 0.
  const std::vector<std::uint8_t>& valid() const { return valid_; }

 private:
  struct Frame;

  Frame frame_of(const double* depth_m, const CameraIntrinsics& camera, const PixelRectangle& at,
                 const RigidTransform& X_WC) const;
  void prepare(const Frame& frame);
  void run(const Frame& frame, PointCloud& cloud);
  void clear_beside(const PointPlanes& to, const Frame& frame, int row, int reach, int first, int last) const;
  void write_points(const Frame& frame, int row, int reach, double scale, bool changed,
                    const PointPlanes& to);
  PixelRow pixels(const Frame& frame, int row, int first, int last, bool changed) const;
  void filter_band(const Frame& frame, int first, int last, float* scratch);
  void normals_band(const Frame& frame, int first, int last, float* scratch, PointCloud& cloud);
  PointPlanes planes(std::vector<float>& values, int column) const;

  const DepthPipelineSettings settings_;
  const Kernels& kernels_;
  std::ptrdiff_t stride_ = 0;
  std::size_t plane_size_ = 0;
  // Planes with a border: points in units of the filter, points in units of the normals, normals.
  std::vector<float> raw_, smooth_, normals_, change_, rays_x_, rays_y_, scratch_;
  std::vector<double> wide_rays_x_, wide_rays_y_, depth_m_;
  std::vector<std::uint8_t> valid_;
};

}  // namespace remote_touch
