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

// Returns frame 0. subject: the subject of error messages, such as "trajectory.name = image-press". Throws
// InputError if the frame is not an image, if the number of its points is not the number of its pixels, or if
// no pixel has a depth.
FrameImage first_image(const Scenario& scenario, const std::string& subject);

// Returns a frame as an image of the camera that took `first`. The camera may have moved: the layout has the
// pose of this frame. Throws InputError, with the number of the frame, if require_image_of() does.
FrameImage image_of(const Scenario& scenario, int frame, const ImageLayout& first,
                    const std::string& subject);

// Throws InputError, with the number of the frame, unless the points of the frame are the pixels of an image
// with the size and the camera of `first`. The camera counts as the same if each measured point is seen at
// most one pixel, plus the slack of both images, away from its own pixel. One pixel is allowed because the
// fit of a camera to the points of a frame may be off by half a pixel in each of the two images. A frame
// without a measured point is accepted, whatever its number of points: all its pixels are holes.
void require_image_of(const ImageLayout& first, const PointCloud& frame, int number,
                      const std::string& subject);

}  // namespace remote_touch
