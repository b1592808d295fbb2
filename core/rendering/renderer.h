// The interface of every haptic renderer: frames at the camera's rate, steps at the haptic rate. Beside it,
// what most renderers need: the order of frames, data that is prepared from a frame, and the velocity of the
// surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

// Receives the frames of a stream.
class FrameReceiver {
 public:
  virtual ~FrameReceiver() = default;
  virtual void on_frame(const Frame& frame) = 0;
};

class Renderer : public FrameReceiver {
 public:
  // Does the slow part of processing a frame, so that on_frame() is short. Sets frame.prepared for renderers
  // of the same kind and settings. May run in parallel to on_frame() and step(), so it reads no live
  // parameter. The results of the renderer do not depend on it.
  virtual void prepare(Frame& /*frame*/) const {}
  // Reserves memory for frames of `points` points. An image counts with its number of pixels, both sides
  // rounded up to multiples of 16. Afterwards on_frame() of a prepared frame allocates nothing. on_frame()
  // releases the previous frame: the caller keeps a reference to that one if memory must not be freed there
  // either.
  virtual void reserve(std::size_t /*points*/) {}
  // Adds a new frame, prepared or not. A frame that is not newer than the last one is dropped, and the status
  // of the next output reports it.
  void on_frame(const Frame& frame) override = 0;
  // Returns the settings that are marked live, with pointers to the renderer's own values. The thread of
  // step() may set these values between two steps, to others that validate() allows. parameters_changed()
  // then applies them, without an allocation.
  virtual Parameters live_parameters() { return {}; }
  virtual void parameters_changed() {}
  // Computes one haptic tick at time_s, which must not decrease. It does not allocate, lock or throw: errors
  // are reported as a status.
  virtual RenderOutput step(const DeviceState& device, double time_s) = 0;
};

// Returns the number of ticks between two calls of a renderer or of a simulated hand: from before_s to now_s,
// rounded, and at least 1. It is also 1 if the time does not advance, decreases or is NaN.
inline double elapsed_ticks(double before_s, double now_s, double haptic_rate_hz) {
  return std::max(1.0, std::floor((now_s - before_s) * haptic_rate_hz + 0.5));
}

// The newest frame of a stream. A frame that was captured no later than the newest one is dropped, and the
// drop is reported once.
class FrameOrder {
 public:
  // Returns true if the frame was captured after the newest one, or is the first.
  bool is_newer(const Frame& frame) const;
  // Same as is_newer(). A newer frame becomes the newest one; any other frame counts as dropped.
  bool accept_if_newer(const Frame& frame);
  int newest() const { return index_; }  // index of the newest frame; -1 before the first
  double captured_s() const { return captured_s_; }

  // Returns the status of a tick: stale_frame_dropped if `otherwise` is ok and a frame was dropped since the
  // last tick, else `otherwise`.
  RenderStatus status(RenderStatus otherwise) {
    const bool dropped = std::exchange(dropped_, false);
    return dropped && otherwise == RenderStatus::ok ? RenderStatus::stale_frame_dropped : otherwise;
  }

 private:
  int index_ = -1;
  double captured_s_ = 0;
  bool dropped_ = false;
};

// The data structure that a renderer reads in place of a cloud's columns, such as a tree. It is built once
// per frame, in advance by prepare() or in on_frame(). Form: any class with assign(const PointCloud&,
// settings...).
template <class Form>
struct PreparedForm final : FramePreparation {
  Form form;
};

template <class Form, class... Settings>
std::shared_ptr<const PreparedForm<Form>> prepared_form(const NeighbourSearch& points, const Kernels& kernels,
                                                        const Settings&... settings) {
  const auto made = std::make_shared<PreparedForm<Form>>();
  PointCloud buffer;
  made->form.assign(points.every_point(kernels, buffer), settings...);
  return made;
}

// Returns the form of the frame. Builds it now unless it was prepared; only this case allocates.
template <class Form, class... Settings>
std::shared_ptr<const Form> form_of(const Frame& frame, const Kernels& kernels, const Settings&... settings) {
  auto prepared = std::dynamic_pointer_cast<const PreparedForm<Form>>(frame.prepared);
  if (!prepared) prepared = prepared_form<Form>(*frame.points, kernels, settings...);
  return {prepared, &prepared->form};
}

// The interval between the frames of a stream, without pauses of the stream. A stream continues at its former
// rate after a pause, so a pause does not predict when the next frame comes. The part of an interval above a
// limit counts as a pause. The limit is kMaxRatio times the previous interval without its own pause. It grows
// with each longer interval, so a stream that becomes slower is accepted after a few frames. The first
// interval of a stream has no limit.
class UsualInterval {
 public:
  // Two frames in a row may be lost without a pause, as with the default max_prediction_s of 0.1 s at 30 Hz.
  static constexpr double kMaxRatio = 3;

  // Returns the interval that ends with the newest frame, s, without the part that is a pause.
  double without_pause(double interval_s) const { return std::min(interval_s, longest_s_); }
  // Adds an interval that has ended. An interval of 0 is ignored.
  void add(double interval_s) {
    if (interval_s > 0) longest_s_ = kMaxRatio * without_pause(interval_s);
  }

 private:
  double longest_s_ = std::numeric_limits<double>::infinity();
};

// Estimate of the point cloud velocity, 4.2.5: the speed of the surface along the proxy's normal, positive
// towards the proxy.
class SurfaceVelocity {
 public:
  // max_interval_s bounds how far ahead (4.3) extrapolates when frames are missing.
  explicit SurfaceVelocity(double max_interval_s)
      : max_interval_s_(max_interval_s), horizon_s_(max_interval_s) {}

  // Processes a new frame, with the normal estimated just before it. Returns the correction s_j of (4.3), to
  // be added to the proxy. The interval is the time between the captures of the two frames: 1/f_c for a
  // steady stream. Frames that follow each other without a step between them count as one.
  Vec3 on_frame(double captured_s, const Vec3& normal);
  // Adds the growth of a forbidden region under the proxy in the newest frame, m. on_step() subtracts it,
  // because it is no motion of the cloud. Call it between on_frame() and on_step().
  void on_growth(double growth_m) { growth_m_ += growth_m; }
  // Corrects the estimate by the first proxy step after a frame, (4.13); later steps change nothing. It may
  // be a step of any state: a free step back to the surface shows that the estimate was too high. The
  // estimate is never negative and never reset.
  void on_step(const Vec3& step);

  // Replaces on_frame() and on_step() if the motion is measured by other means. The velocity along the normal
  // may then be negative.
  void on_measured(double captured_s, double velocity_m_per_s, const Vec3& normal);

  double m_per_s() const { return velocity_m_per_s_; }
  // Returns v_hat as a vector along the normal of the last frame.
  Vec3 vector() const { return velocity_m_per_s_ * normal_; }
  // Returns the time after a frame during which v_hat may be used, s: the larger of max_interval_s and the
  // newest interval between frames without its pause.
  double horizon_s() const { return horizon_s_; }

 private:
  void set_horizon();

  double max_interval_s_;
  double horizon_s_;
  double velocity_m_per_s_ = 0;  // v_0 = 0
  double captured_s_ = 0;
  double interval_s_ = 0;  // time since the frame before the last step; 0 before the second frame
  UsualInterval usual_interval_;
  double frame_correction_m_ = 0;  // displacement of the proxy along the normal in that time
  double growth_m_ = 0;            // growth of regions in that time
  Vec3 normal_ = Vec3::Zero();
  bool has_frame_ = false;
  bool awaits_step_ = false;
};

}  // namespace remote_touch
