// Points of true objects in a recording, and the pixels around such a point in every frame. A run that sees
// only these pixels touches the same points as one that sees the whole frames, at a small part of the time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "scenarios/meshes/depth_raster.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

// Returns the image that the camera would take of the true objects in a frame without errors.
// RasterImage::mesh is the index in RecordedTruth::objects(). Objects without a pose in this frame are not in
// the image. source: number of the frame in the recording.
RasterImage true_image(const RecordedTruth& truth, std::size_t source, const CameraIntrinsics& camera);
// Returns the normal of the triangle that a pixel sees, towards the camera, in the camera frame. Pre: the
// pixel sees a triangle.
Vec3 true_normal_C(const RecordedTruth& truth, std::size_t source, const RasterImage& image,
                   std::size_t pixel);

// A point of an object's mesh, in the middle of the part that one frame shows.
struct TouchedPoint {
  std::string object;
  std::size_t index = 0;    // index of the object in RecordedTruth::objects()
  Vec3 p_O = Vec3::Zero();  // frame of the object
  // Unit vector along which a hand comes: the normal of the mesh where it is flat around the point, else the
  // direction to the camera in that frame.
  Vec3 outwards_O = Vec3::UnitZ();
};

// Returns the touched points of at most `most` objects, those first that fill the most pixels. The camera has
// measured a point within 30 mm of the true depth there, at least 10 mm from holes and depth edges
// (surface_support.h), and sees the mesh at 60 degrees or less from its normal. Points whose surroundings are
// flat, within 3 mm up to a distance of 15 mm, are preferred. An object without such a pixel is left out.
// Throws InputError if the frame is not an image. Pre: scene.truth() is not null.
std::vector<TouchedPoint> touched_points(const RecordedScene& scene, int frame, std::size_t most);

// The pixels around a touched point: the rectangle that shows 45 mm around it in all frames. Frames, times,
// camera and both surfaces are those of the recording. The surfaces are known at times of frames only, and
// the measured one only inside of the rectangle.
class RecordingWindow final : public Scenario {
 public:
  // frames: how many frames will be added.
  RecordingWindow(const RecordedScene& scene, const TouchedPoint& point, int frames);
  // Adds the next frame. If the pose of the object is unknown, that of the last frame with a pose is used.
  void add_frame();

  const TouchedPoint& point() const { return point_; }
  // The point and the direction of TouchedPoint in a frame, world frame.
  const Vec3& p_W(int frame) const { return frame_at(frame).p_W; }
  const Vec3& outwards_W(int frame) const { return frame_at(frame).outwards_W; }

  Vec3 camera_W(double time_s) const { return frame_at(newest_frame(time_s)).X_WC.translation(); }

  double frame_rate_hz() const override { return scene_.frame_rate_hz(); }
  int frame_count() const override { return static_cast<int>(frames_.size()); }
  double captured_s(int frame) const override { return scene_.captured_s(frame); }
  // The last frame is not repeated, so that the contact is judged in all frames alike: only while the frame
  // is the newest.
  bool ends() const override { return true; }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override { return frame_at(frame).points; }
  PointCloud cloud(int frame) const override;
  double signed_distance(const Vec3& p_W, double time_s) const override;
  bool has_measured_distance() const override { return true; }
  double measured_distance(const Vec3& p_W, double time_s) const override;

 private:
  struct WindowFrame {
    std::shared_ptr<const NeighbourSearch> points;
    RigidTransform X_WC;
    std::size_t source;  // the frame's number in the recording
    Vec3 p_W, outwards_W;
  };
  const WindowFrame& frame_at(int frame) const { return frames_.at(static_cast<std::size_t>(frame)); }

  const RecordedScene& scene_;
  TouchedPoint point_;
  PixelRectangle rectangle_;
  RigidTransform X_WO_ = RigidTransform::Identity();  // pose of the object in the newest frame that has one
  std::vector<WindowFrame> frames_;
};

// Returns a window for each point, with the first `frames` frames of the recording. Each frame is read once.
std::vector<std::unique_ptr<const RecordingWindow>> windows_around(const std::vector<TouchedPoint>& points,
                                                                   const RecordedScene& scene, int frames);

}  // namespace remote_touch
