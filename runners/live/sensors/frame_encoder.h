// The frames of a scenario as the frames of one sensor.
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
    std::string name = "--depth";  // of the source, for messages
    // Maximum depth along the optical axis, in metres; 0: not known.
    double max_depth_m = 0;
    // Unit of the depths, in metres. 0: the least of 0.1, 0.2, 0.5, 1 and 2 mm with which 16 bits reach
    // max_depth_m and every point of the first frame; the last of these reaches 131.07 m.
    double unit_m = 0;
    // Throws InputError for a frame that the rules of the run cannot be applied to, such as one without
    // colours; called with every frame that has points. Empty: no check.
    std::function<void(const PointCloud&)> require = {};
  };

  // The view is that of the first frame. Frames are sent as points, in the world frame, if the first frame is
  // no depth image, or one that a pinhole camera with 16 bits of depth cannot show: a lens bends its rays by
  // more than 1 px, or points are behind the camera or farther than 131.07 m.
  FrameEncoder(const Settings& settings, const PointCloud& first);

  SensorView& view() { return view_; }
  const SensorView& view() const { return view_; }

  // Sets the points and colours of the frame. With this view, cloud_of(frame) has the same measured points:
  // points of a depth image on the rays of their pixels, less than 1 px from where they were. Their depths
  // differ by half a unit at most, or by one where they are less than half a unit. Their normals are not
  // sent; a depth_pipeline computes them. Frames that are sent as points have the nearest floats, and normals
  // if the scenario has them. A frame without a measured point becomes an image of holes, or a cloud without
  // points. If the first frame has colours, all have: the points of a frame without them get kNoColour. If it
  // has none, none are sent. Throws InputError, which names the frame, if the view cannot carry it: another
  // camera, pose or size of image; a point behind the camera or beyond 65535 units; other columns; normals
  // that the first frame has not, or the reverse; forbidden regions or stiffnesses of single points, which no
  // sensor sends.
  void encode(const PointCloud& cloud, int index, SensorFrame& frame) const;

 private:
  // Functions that return a text return the error in the frame; empty if there is none.
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
