// What makes a cloud with normals of a depth frame. DepthPipeline does it on the CPU; another one may do it
// elsewhere, with the same bits.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/cloud/camera.h"
#include "core/cloud/point_cloud.h"
#include "core/parameters/parameter.h"
#include "core/virtual_fixtures/hue_range.h"

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
  bool sharp_edges = false;

  bool operator==(const DepthPipelineSettings&) const = default;
};

// The fast setting: a quarter to a third of the default's time. Filter and steps together use every pixel of
// 11 x 11.
inline constexpr DepthPipelineSettings kFastDepthPipeline{
    true, 3, 0.025, 9, 0.02, 2, NormalFit::inverse_depth, true};

Parameters parameters(DepthPipelineSettings& s);
std::string validate(const DepthPipelineSettings& s);

// A whole depth image, camera.width x camera.height depths in m.
struct DepthFrame {
  const double* depth_m;
  CameraIntrinsics camera;
  RigidTransform X_WC;       // registration of the camera in the base frame
  bool keep_points = false;  // the cloud has its points already, and they are not filtered

  std::size_t pixels() const {
    return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  }
};

// A whole depth image as sensors send it.
struct RawDepth {
  const std::uint16_t* units;  // of each pixel; 0: nothing measured
  double metres_per_unit;
  CameraIntrinsics camera;
  RigidTransform X_WC;
  std::span<const std::uint32_t> colour = {};  // of each pixel, 0xRRGGBB; empty: none
};

// Reuses its memory: after the first frame of a size nothing is allocated, if the caller passes the same
// cloud again. One thread at a time. Throws std::invalid_argument if sizes do not match, and a maker of one
// for settings that validate() refuses.
class DepthProcessor {
 public:
  virtual ~DepthProcessor() = default;

  // X_WC is the registration of the camera in the base frame. cloud becomes points, normals and image layout,
  // without other columns; NaN where there is no point, or no plane for a normal.
  void process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC,
               PointCloud& cloud);
  PointCloud process(const DepthImage& depth, const CameraIntrinsics& camera, const RigidTransform& X_WC);
  // An organised cloud, in place: its depth image is taken from the points, all other columns stay.
  void process(PointCloud& cloud);

  // A whole frame at once, for a processor to which copying takes long: process(cloud), then the columns of
  // r_f and k_s by the steps and the cloud's colours. False: this processor does not do that, and the cloud
  // is as it was.
  virtual bool process_all(PointCloud& /*cloud*/, const HueSteps& /*steps*/) { return false; }
  // The same from a sensor's image, which first becomes a cloud with its colours, as by cloud_from_depth();
  // without the columns of r_f and k_s where the steps are null.
  virtual bool process_all(const RawDepth& /*raw*/, PointCloud& /*cloud*/, const HueSteps* /*steps*/) {
    return false;
  }

  // Normals, and unless they are kept points, of every pixel of the frame. The cloud has columns x, y, z of
  // the frame's size, and the image layout.
  virtual void process_frame(const DepthFrame& frame, PointCloud& cloud) = 0;

 protected:
  explicit DepthProcessor(const DepthPipelineSettings& settings);
  DepthProcessor(const DepthProcessor&) = default;
  DepthProcessor& operator=(const DepthProcessor&) = delete;

  // Of an organised cloud: its depth image is taken from the points. Holds until the next call. Throws
  // std::invalid_argument.
  DepthFrame frame_of(const PointCloud& cloud);

  const DepthPipelineSettings settings_;

 private:
  std::vector<double> depth_m_;
};

// Gives the cloud the columns x, y, z and the layout of an image of this camera, and no other ones. What
// stands in the columns is for the caller to write.
void become_image(PointCloud& cloud, const CameraIntrinsics& camera, const RigidTransform& X_WC);
// Throws std::invalid_argument.
void check_sizes(const DepthImage& depth, const CameraIntrinsics& camera);

}  // namespace remote_touch
