// Encodes the frames of a scenario as the frames of one sensor.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "runners/experiment/sessions/sensor_frame.h"

namespace remote_touch {

// A live run has one view: one camera at one pose, or clouds of one layout (see CloudLayout). Encoded frames
// are decoded by cloud_of().
class FrameEncoder {
 public:
  struct Settings {
    std::string name = "--depth";  // name of the source, for messages
    // Maximum depth along the optical axis, in metres; 0: not known.
    double max_depth_m = 0;
    // Unit of the depths, in metres. 0: the least of 0.1, 0.2, 0.5, 1 and 2 mm with which 16 bits reach
    // max_depth_m and every point of the first frame; the last of these reaches 131.07 m.
    double unit_m = 0;
    // Checks every frame that has points. Throws InputError for a frame to which the rules of the run cannot
    // be applied, such as one without colours. Empty: no check.
    std::function<void(const PointCloud&)> require = {};
  };

  // The view is that of the first frame. Frames are sent as points, in the world frame, if the first frame is
  // no depth image, or if a pinhole camera with 16 bits of depth cannot show it: a lens bends its rays by
  // more than 1 px, or points are behind the camera or deeper than 65535 units.
  FrameEncoder(const Settings& settings, const PointCloud& first);

  SensorView& view() { return view_; }
  const SensorView& view() const { return view_; }

  // Sets the depths or points, and the colours, of the frame. With this view, cloud_of(frame) has the same
  // measured points:
  // - Points of a depth image are on the rays of their pixels, less than 1 px from their original position.
  //   Their depths differ by half a unit at most; a depth of less than half a unit becomes one unit. Their
  //   normals are not sent; a depth_pipeline computes them.
  // - Frames that are sent as points have the nearest floats, and normals if the scenario has them.
  // If the first frame has colours, all frames have them: the points of a frame without colours get
  // kNoColour. If the first frame has none, none are sent.
  //
  // A frame without a measured point that does not fit the view becomes an image of holes, or a cloud without
  // points. Any other frame that does not fit throws InputError, which names the frame. The reasons are
  // another camera, pose or size of image; a point behind the camera or beyond 65535 units; other columns;
  // normals that the first frame has not, or the reverse; and forbidden regions or stiffnesses of single
  // points, which no sensor sends.
  void encode(const PointCloud& cloud, int index, SensorFrame& frame) const;

 private:
  // Functions that return a text return the problem of the frame; the text is empty if there is none.
  void write_nothing(SensorFrame& frame) const;
  std::string problem_of(const PointCloud& cloud) const;
  std::string image_problem(const PointCloud& cloud) const;
  std::string layout_problem(const PointCloud& cloud) const;
  std::string pixel_problem(const Vec3& p_C, std::size_t pixel) const;
  std::string write_depth(const PointCloud& cloud, SensorFrame& frame) const;

  const std::string name_;
  const std::function<void(const PointCloud&)> require_;
  SensorView view_;
  RigidTransform X_CW_ = RigidTransform::Identity();
};

}  // namespace remote_touch
