// Viewing rays of the pixels of a depth image, from a CameraInfo. They convert a depth image to a cloud.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "scenarios/recordings/bags/messages.h"

namespace remote_touch {

// Size in pixels of the images of a camera: the size of its region of interest, divided by its binning.
struct ImageSize {
  std::uint32_t width = 0, height = 0;
};
// Throws InputError about the subject, with the name of the field, if the region is not within
// width x height, or if the binning leaves no pixel.
ImageSize image_size(const CameraInfoMessage& info, const std::string& subject);

// Binning by b: pixel u of the image covers the pixels b u + x_offset to b u + x_offset + b - 1 of the
// sensor, and its ray is that of their mean position. Therefore fx = K[0] / b and cx =
// (K[2] - x_offset - (b - 1) / 2) / b, the same along y, with P instead of K if rectified.
//
// An image as measured has rays that its lens bends (plumb bob: k1, k2, p1, p2, k3). A rectified image is
// that of a pinhole. So is an image whose coefficients are all 0, unless the lens is a fisheye (equidistant).
// The points of a bending lens are those of the measured pixels, on their true rays, in the order of a
// pinhole image with the intrinsics K: each of its pixels has the point whose ray passes nearest, within
// pixel_slack. A pixel near the edge may have no point, and where the lens shrinks the image two pixels may
// have the same point.
class ImageRays {
 public:
  // rectified: the image was undistorted before it was recorded, and its intrinsics are P. Throws InputError
  // about the subject in these cases:
  // - image_size() refuses the region or the binning, or the image has no pixel or more than kMaxImagePixels;
  // - the intrinsics are not finite, the focal lengths are not within 1e-6 to 1e6 px, or the centre is 1e6 px
  //   or more away;
  // - the lens is of another model;
  // - K or P is not (fx 0 cx; 0 fy cy; 0 0 1): it has skew, or P has P[3] or P[7] of the second camera of a
  //   stereo pair, whose points are in the frame of the first camera;
  // - a rectified image shows another region (do_rectify).
  ImageRays(const CameraInfoMessage& info, bool rectified, const std::string& subject);

  const CameraIntrinsics& camera() const { return camera_; }
  bool has_distortion() const { return !source_.empty(); }
  // Returns the cloud in the camera frame: x right, y down, z forward. Pre: the image has the camera's size.
  PointCloud cloud(const DepthImage& depth) const;

 private:
  void make_table(const CameraInfoMessage& info);

  CameraIntrinsics camera_;
  // One entry for each pixel of the pinhole image: index of the measured pixel (-1: none), and the ray of the
  // measured pixel with z = 1. Empty if the lens does not bend the rays.
  std::vector<int> source_;
  std::vector<double> ray_x_, ray_y_;
  double slack_ = 0;
};

}  // namespace remote_touch
