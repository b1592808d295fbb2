// Makes a cloud with normals from a depth frame: filter (7.1), (7.2) and the normals of 6.2.1.
//
// The filter smooths depths spatially: v0' = sum v_k phi(k) / sum phi(k) over a window of pixels, where
// phi(k) = exp(-|p_k - p_0|^2 / (2 sigma_f^2)). The distances |p_k - p_0| are Cartesian distances between the
// points as measured. The filtered depths are then unprojected to points again. The normal of each point is
// that of the plane which fits its filtered neighbours by weighted total least squares: the weights psi of
// (4.2) fall from 1 at the point to 0 at the radius, and the normal is the eigenvector of the smallest
// eigenvalue of the covariance, turned towards the sensor. NormalFit has a faster alternative.
//
// sharp_edges (not in the dissertation): a pixel may use the normal of one of eight windows around its own.
// Each of them is shifted by half the width of the normal's window plus half that of the filter's. The pixel
// uses the window that fits best, provided that it fits clearly better than its own: its mean square error
// plus the squared distance of the pixel's own point from its plane is less than a quarter of the own
// window's error. The own window of a pixel averages both sides of an edge; a window that ends at the edge
// has one side only.
//
// A depth that is NaN, infinite, zero, negative, or 1 km and more is a hole: it gives no point and has no
// influence. The pipeline computes in single precision in the camera frame: normals are within 0.05 degrees
// of those in double. The result has the same bits on every machine and for any number of threads. A
// rectangle has the same bits as these pixels have in the whole frame.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dissertation/depth/depth_processor.h"
#include "core/kernels/depth_kernels.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

struct PixelRectangle {
  int left = 0, top = 0;
  int width = 0, height = 0;
};

// Depth pipeline on the CPU, with the kernels of its instruction set.
class DepthPipeline final : public DepthProcessor {
 public:
  DepthPipeline(const DepthPipelineSettings& settings, const Kernels& kernels);

  using DepthProcessor::process;
  // Processes only the pixels of the rectangle; the time depends on their number, not on that of the image.
  // The result is the same as in the whole frame, bit for bit. The image layout is that of a camera with
  // these pixels alone. Throws std::invalid_argument if the rectangle is not in the image.
  void process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC,
               const PixelRectangle& rectangle, PointCloud& cloud);
  void process_frame(const DepthFrame& frame, PointCloud& cloud) override;

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
  void normals_band(const Frame& frame, int first, int last, float* scratch);
  void row_to_cloud(const Frame& frame, int row, const PointPlanes& normals, PointCloud& cloud);
  std::ptrdiff_t first_pixel() const { return border_ * stride_ + border_; }  // offset in a plane
  PointPlanes planes(std::vector<float>& values, int column) const;
  FitPlanes fit_planes(int column);

  const Kernels& kernels_;
  const int border_;  // width of the border of a plane around the requested pixels
  std::ptrdiff_t stride_ = 0;
  std::size_t plane_size_ = 0;
  // Planes with a border. raw_: measured points in units of the filter, later overwritten with the sharp
  // normals. smooth_: points of the normals in units of the normals: the filtered ones, or the measured ones
  // without the filter. normals_: unit normals.
  std::vector<float> raw_, smooth_, normals_, fits_, change_, rays_x_, rays_y_, scratch_;
  std::vector<double> wide_rays_x_, wide_rays_y_;
  std::vector<std::uint8_t> valid_;
};

}  // namespace remote_touch
