// A cloud with normals from a depth image, 6.2.1. First its filter, (7.1) and (7.2), one statement each: the
// kernel of core/kernels/depth_kernels.h filters many pixels at a time and is tested against this form.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/kernels/depth_kernels.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch::equations {

// The weight phi of a point in the filter of the point p0, (7.2). Lengths are in m.
inline double filter_weight(const Vec3& p, const Vec3& p0, double sigma_f_m) {
  return std::exp(-(p - p0).squaredNorm() / (2 * sigma_f_m * sigma_f_m));  // (7.2)
}

// The filtered depth of the point p0, (7.1). window: the points of the pixels around it and its own, camera
// frame.
inline double filtered_depth(std::span<const Vec3> window, const Vec3& p0, double sigma_f_m) {
  double sum = 0, total = 0;
  for (const Vec3& p : window)
    sum += filter_weight(p, p0, sigma_f_m) * p.z(), total += filter_weight(p, p0, sigma_f_m);
  return sum / total;  // (7.1)
}

}  // namespace remote_touch::equations

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
namespace remote_touch {

// Interface for computing a cloud with normals from a depth frame. DepthPipeline does it on the CPU; another
// implementation may do it elsewhere, with the same bits.

// Method of computing a normal. total_least_squares fits a plane with the weights psi(q). inverse_depth is
// faster: every plane has an inverse depth that is an affine function of the pixel, and this function is
// fitted with the weights (1 - q^2)^2 in place of psi(q).
enum class NormalFit { total_least_squares, inverse_depth };

struct DepthPipelineSettings {
  bool filter = true;
  int filter_window = 9;
  double sigma_f_m = 0.025;
  int normal_window = 9;
  double normal_radius_m = 0.014;
  int normal_step = 1;
  NormalFit normal_fit = NormalFit::total_least_squares;
  bool sharp_edges = false;

  bool operator==(const DepthPipelineSettings&) const = default;
};

// The fast setting: it needs a quarter to a third of the default's time. The normal uses only every second
// pixel of its window, but the filter fills the gaps: together they use every pixel of 11 x 11.
inline constexpr DepthPipelineSettings kFastDepthPipeline{
    true, 3, 0.025, 9, 0.02, 2, NormalFit::inverse_depth, true};

Parameters parameters(DepthPipelineSettings& s);
std::string validate(const DepthPipelineSettings& s);

// A whole depth image, camera.width x camera.height depths in m.
struct DepthFrame {
  const double* depth_m;
  CameraIntrinsics camera;
  RigidTransform X_WC;      // registration of the camera in the base frame
  bool has_points = false;  // the cloud has its points already, and they are not filtered

  std::size_t pixels() const { return camera.pixels(); }
};

// A whole depth image as sensors send it.
struct RawDepth {
  const std::uint16_t* units;  // measured value of each pixel; 0: nothing measured
  double metres_per_unit;
  CameraIntrinsics camera;
  RigidTransform X_WC;
  std::span<const std::uint32_t> colour = {};  // 0xRRGGBB of each pixel; empty: no colours
};

// A processor reuses its memory: after the first frame of a size it allocates nothing if the caller passes
// the same cloud again. Only one thread may use it at a time. It throws std::invalid_argument if sizes do not
// match. Constructors of implementations throw it for settings that validate() rejects.
class DepthProcessor {
 public:
  virtual ~DepthProcessor() = default;

  // Writes points, normals and image layout into cloud, and clears its other columns. X_WC is the
  // registration of the camera in the base frame. Points and normals are NaN where nothing was measured.
  // Normals are also NaN where there is no plane.
  void process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC,
               PointCloud& cloud);
  PointCloud process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC);
  // Processes an organised cloud in place. Its depth image is computed from its points. The normals are
  // written, and the filtered points if the filter is on; all other columns stay as they are. Throws
  // std::invalid_argument if the cloud has no image layout or not the camera's size.
  void process(PointCloud& cloud);

  // Does the work of process(cloud) and then writes the columns of r_f and k_s, from the steps and the
  // cloud's colours. One call does both because copying to some processors takes long. Returns false, with
  // the cloud unchanged, if this processor does not support it.
  virtual bool process_all(PointCloud& /*cloud*/, const HueSteps& /*steps*/) { return false; }
  // Does the same for a sensor's image, which first becomes a cloud with its colours, as cloud_from_depth()
  // would make it. If steps is null, the columns of r_f and k_s are not written.
  virtual bool process_all(const RawDepth& /*raw*/, PointCloud& /*cloud*/, const HueSteps* /*steps*/) {
    return false;
  }

  // Computes the normals of every pixel of the frame and, unless has_points is set, the points. The cloud
  // has columns x, y, z of the frame's size, and the image layout.
  virtual void process_frame(const DepthFrame& frame, PointCloud& cloud) = 0;

 protected:
  explicit DepthProcessor(const DepthPipelineSettings& settings);
  DepthProcessor(const DepthProcessor&) = default;
  DepthProcessor& operator=(const DepthProcessor&) = delete;

  // Returns the depth frame of an organised cloud, with depths computed from its points. It is valid until
  // the next call. Throws std::invalid_argument if the cloud has no image layout or not the camera's size.
  DepthFrame frame_of(const PointCloud& cloud);

  const DepthPipelineSettings settings_;

 private:
  std::vector<double> depth_m_;
};

// Makes the columns x, y, z as long as an image of this camera, sets the image layout, and clears the columns
// of r_f, k_s and colour. The caller writes the values of x, y, z and the columns of the normals, which are
// not changed here.
void become_image(PointCloud& cloud, const CameraIntrinsics& camera, const RigidTransform& X_WC);
// Throws std::invalid_argument if the depth image does not have the camera's size.
void check_sizes(const DepthImage& depth, const CameraIntrinsics& camera);

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
