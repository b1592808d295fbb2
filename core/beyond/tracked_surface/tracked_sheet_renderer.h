// 3-DOF rendering of a tracked sheet: the proxy of chapter 4 on a surface that is followed from frame to
// frame and denoised. The method is not in the dissertation; its inputs are those of the proxy, points and
// times.
//
// The sheet in front of the proxy is found again in each frame at its predicted position, and is registered
// to the previous frame. A proxy that the sheet holds back moves with it; a free proxy moves only if the
// sheet swept over it. The sheet's points are moved onto the local planes that fit them, as far as noise
// explains their distances. The ticks are those of the proxy, with the measured velocity in (4.15).
#pragma once

#include <limits>
#include <string>

#include "core/beyond/tracked_surface/sheet_tracker.h"
#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/rendering/surface_velocity.h"

namespace remote_touch {

struct TrackedSheetParameters {
  ProxyParameters proxy;
  SheetSettings sheet;
};

Parameters parameters(TrackedSheetParameters& p);
std::string validate(const TrackedSheetParameters& p);
// A sheet that is fitted to the points holds the ball, also between the points, so ball_radius_m is 0.
inline RenderedContact rendered_contact(const TrackedSheetParameters& p) {
  return {p.proxy.contact_radius_m()};
}

class TrackedSheetRenderer final : public Renderer {
 public:
  // haptic_rate_hz: the rate at which step() is called.
  TrackedSheetRenderer(const TrackedSheetParameters& parameters, double haptic_rate_hz,
                       const Kernels& kernels);
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  void parameters_changed() override { proxy_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  ProxyPosition proxy_position() const { return {proxy_.proxy_W(), proxy_.in_contact()}; }
  void show(const SheetUpdate& update);

  const int max_hold_frames_;
  ProxyRenderer proxy_;
  SheetTracker tracker_;
  std::shared_ptr<const NeighbourSearch> shown_;  // points that the proxy uses
  double captured_s_ = 0;                         // time of the newest frame in which the sheet was seen
  UsualInterval usual_interval_;                  // interval between such frames
  double hold_until_s_ = std::numeric_limits<double>::infinity();  // finite while the sheet is missing
  bool has_frame_ = false;
  bool placed_ = false;  // the proxy has started at the HIP
};

}  // namespace remote_touch
