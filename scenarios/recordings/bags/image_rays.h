// Viewing rays of the pixels of a depth image, from a CameraInfo: with them a depth image becomes a cloud.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "scenarios/recordings/bags/messages.h"

namespace remote_touch {

// The size in pixels of the images of a camera: that of its region of interest, divided by its binning.
struct ImageSize {
  std::uint32_t width = 0, height = 0;
};
// Throws InputError about the subject, naming the field, for a region that is not within width x height, and
// for a binning that leaves no pixel.
ImageSize image_size(const CameraInfoMessage& info, const std::string& subject);

// The camera has square binning cells: pixel u of the image covers the pixels b u + x_offset to
// b u + x_offset + b - 1 of the sensor and looks along the ray of their mean position. So
// fx = K[0] / b and cx = (K[2] - x_offset - (b - 1) / 2) / b, the same along y, with P for K if rectified.
//
// The lens of an image as measured bends its rays (plumb bob: k1, k2, p1, p2, k3); a rectified image, or one
// of a lens whose coefficients are 0, is that of a pinhole, unless the lens is a fisheye (equidistant). With
// a lens the points are those of the measured pixels, on their true rays, in the order of a pinhole image
// with the intrinsics K: a pixel of it has the point whose ray passes nearest, within pixel_slack. A pixel
// near the edge may have none, and a point may come in two pixels where the lens shrinks the image.
class ImageRays {
 public:
  // rectified: the image was undistorted before it was recorded, its intrinsics are P. Throws InputError
  // about the subject in these cases:
  // - the intrinsics are not finite, or the focal lengths not above 1e-6;
  // - the lens is of another model;
  // - K or P is not (fx 0 cx; 0 fy cy; 0 0 1): it has skew, or P[3] or P[7] of the second camera of a stereo
  //   pair, whose points are in the frame of the first camera;
  // - image_size() refuses the region or the binning, or a rectified image shows another region (do_rectify).
  ImageRays(const CameraInfoMessage& info, bool rectified, const std::string& subject);

  const CameraIntrinsics& camera() const { return camera_; }
  bool has_distortion() const { return !source_.empty(); }
  // Camera frame: x right, y down, z forward. Pre: the image has the camera's size.
  PointCloud cloud(const DepthImage& depth) const;

 private:
  void make_table(const CameraInfoMessage& info);

  CameraIntrinsics camera_;
  // Entry for each pixel of the pinhole image: the measured pixel (or -1), and the ray of the measured pixel
  // with z = 1. Empty if the lens does not bend the rays.
  std::vector<int> source_;
  std::vector<double> ray_x_, ray_y_;
  double slack_ = 0;
};

}  // namespace remote_touch
