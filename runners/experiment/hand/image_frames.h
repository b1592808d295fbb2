// The frames of a scenario as depth images of one camera, for hands that follow the pixels of an image.
#pragma once

#include <string>

#include "core/geometry/camera.h"
#include "core/geometry/point_cloud.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// A frame as a depth image: the depth of each pixel along the optical axis, NaN where nothing was measured.
struct FrameImage {
  ImageLayout layout;
  DepthImage depth;
};

// Returns frame 0. The subject is that of the messages, such as "trajectory.name = image-press". Throws
// InputError if the frame is not an image, or if the number of its points is not the number of its pixels.
FrameImage first_image(const Scenario& scenario, const std::string& subject);

// Returns a frame of the camera that took the image `first`. Its pose may be another: the layout has the pose
// of this frame. Throws InputError, with the number of the frame, if require_image_of() does.
FrameImage image_of(const Scenario& scenario, int frame, const ImageLayout& first,
                    const std::string& subject);

// Throws InputError, with the number of the frame, unless the points of the frame are the pixels of an image
// of the same size as `first`, and of the same camera: each measured point is at most one pixel, and the
// slack of both images, off the viewing ray that its pixel has in `first`. The fit of a camera to the points
// of a frame may leave half a pixel in each. A frame without a measured point, of any number of points, is an
// image in which all pixels are holes.
void require_image_of(const ImageLayout& first, const PointCloud& frame, int number,
                      const std::string& subject);

}  // namespace remote_touch
