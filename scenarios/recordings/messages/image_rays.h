// Where the pixels of a depth image look, from a CameraInfo: a depth image becomes a cloud.
#pragma once

#include <string>
#include <vector>

#include "core/cloud/camera.h"
#include "scenarios/recordings/messages/messages.h"

namespace remote_touch {

// The lens of an image as measured bends its rays (plumb bob: k1, k2, p1, p2, k3); a rectified image, or one
// of a lens whose coefficients are 0, is that of a pinhole, unless the lens is a fisheye (equidistant). With
// a lens the points are those of the measured pixels, on their true rays, in the order of a pinhole image
// with the intrinsics K: a pixel of it has the point whose ray passes nearest, within pixel_slack. A pixel
// near the edge may have none, and a point may come in two pixels where the lens shrinks the image.
class ImageRays {
 public:
  // Throws InputError about the subject when the intrinsics are not finite or the focal lengths not above
  // 1e-6, or the lens is of another model. rectified: the image was undistorted before it was recorded, its
  // intrinsics are P.
  ImageRays(const CameraInfoMessage& info, bool rectified, const std::string& subject);

  const CameraIntrinsics& camera() const { return camera_; }
  bool has_distortion() const { return !source_.empty(); }
  // Camera frame: x right, y down, z forward. Pre: the image has the camera's size.
  PointCloud cloud(const DepthImage& depth) const;

 private:
  void make_table(const CameraInfoMessage& info);

  CameraIntrinsics camera_;
  // For each pixel of the pinhole image: the measured pixel (or -1), and the ray of that one, with z = 1.
  std::vector<int> source_;
  std::vector<double> ray_x_, ray_y_;
  double slack_ = 0;
};

}  // namespace remote_touch
