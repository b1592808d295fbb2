// Runs in which a hand presses a point of a true object, and the errors of renderer and camera at the
// contact.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "scenarios/objects/mesh_scene.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

// Points of true objects in a recording, and the pixels around such a point in every frame. A run that sees
// only these pixels touches the same points as one that sees the whole frames, at a small part of the time.

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
// (image_surface.h), and sees the mesh at 60 degrees or less from its normal. Points whose surroundings are
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
  std::optional<double> measured_distance(const Vec3& p_W, double time_s) const override;

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

// The renderer that touches a recording, and how its frames are processed before.
struct Toucher {
  std::string name;            // text for titles
  std::string renderer;        // JSON
  std::string depth_pipeline;  // JSON; empty: none
  double rest_distance_m = 0;  // distance of the reported position from a surface that it touches
};

// Returns the experiment of a run over the recording. The hand moves with the true object. It comes to the
// point from 30 mm outwards within three frames, stays 10 mm behind the true surface for twelve, and comes
// again. The run ends 0.1 s after the last frame of the window. scenario: that section as JSON.
Experiment pressing_experiment(const nlohmann::ordered_json& scenario, const RecordingWindow& window,
                               const Toucher& toucher);

// Runs the experiment on the window in place of its scenario. Returns the contact point in the last tick of
// each frame, world frame: rest_distance_m from the reported position, against the renderer's own normal. It
// is NaN if nothing is touched, or if the points are touched from behind, which the camera does not see. Each
// press has a renderer of its own, because a proxy that popped through would stay behind the points. Pre: the
// experiment has no fixtures, guidance, changes, operator or device. Several threads may use one window.
std::vector<Vec3> contact_points(const Experiment& experiment, const RecordingWindow& window,
                                 double rest_distance_m, const Kernels& kernels);

// The errors at a contact point. Both are NaN if the contact point or one of the surfaces is unknown.
struct ContactError {
  double renderer_m = kNoValue;  // height of the contact point over the measured surface
  double camera_m = kNoValue;    // height of the measured surface over the true one, at the contact point
  double total_m() const { return renderer_m + camera_m; }  // height of the contact point over the true one
};
// Returns the errors in each frame. Pre: contacts_W has one contact point for each frame of the window.
std::vector<ContactError> contact_errors(const std::vector<Vec3>& contacts_W, const RecordingWindow& window);

// Makes the errors NaN in every frame in which they are NaN in one of the runs, so that runs are compared
// over the same frames. Pre: all runs have the same number of frames.
void keep_common_frames(std::vector<std::vector<ContactError>>& runs);

// Statistics of values over the frames in which they are known; NaN if there are none.
struct ErrorStatistics {
  double frames = 0, rms_m = kNoValue, mean_m = kNoValue;
};
using ErrorValue = double (*)(const ContactError&);
// offset_m is added to each value.
ErrorStatistics statistics_of(const std::vector<ContactError>& errors, ErrorValue value, double offset_m = 0);
// Returns the rms change of the value from one frame to the next, divided by the square root of 2: the
// standard deviation of errors that are independent in each frame. NaN if no two successive values are known.
double frame_noise_m(const std::vector<ContactError>& errors, ErrorValue value);

inline double renderer_error_m(const ContactError& error) {
  return error.renderer_m;
}
inline double camera_error_m(const ContactError& error) {
  return error.camera_m;
}
inline double total_error_m(const ContactError& error) {
  return error.total_m();
}

}  // namespace remote_touch
