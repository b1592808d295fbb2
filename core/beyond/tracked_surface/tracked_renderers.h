// Renderers of tracked sheets, surfaces that are followed from frame to frame and denoised: for a HIP, and
// for a tool.
#pragma once

#include <limits>
#include <string>

#include "core/beyond/tracked_surface/sheet_patches.h"
#include "core/beyond/tracked_surface/sheet_tracker.h"
#include "core/dissertation/proxy/proxy_renderer.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// 3-DOF rendering of a tracked sheet: the proxy of chapter 4 on a surface that is followed from frame to
// frame and denoised. The method is not in the dissertation; its inputs are those of the proxy, points and
// times.
//
// The sheet in front of the proxy is found again in each frame at its predicted position, and is registered
// to the previous frame. A proxy that the sheet holds back moves with it; a free proxy moves only if the
// sheet swept over it. The sheet's points are moved onto the local planes that fit them, as far as noise
// explains their distances. The ticks are those of the proxy, with the measured velocity in (4.15).

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

// 6-DOF rendering of tracked sheets: the tool of chapter 6 on surfaces that are followed from frame to frame
// and denoised. The method is not in the dissertation; its inputs are those of the tool, points and times.
//
// The sheets around the tool are found again in each frame at their predicted positions. A tool that they
// hold moves with them, rotation included; a free tool moves only if a sheet swept over it. The points of the
// sheets are moved onto the sheets and receive the normals of the sheets. The ticks are those of the tool on
// these points, with the measured velocity and rotation rate in (4.15).

struct TrackedToolParameters {
  ToolParameters tool;
  SheetSettings sheet;
  double sheet_unit_m = 0.005;
  int max_patches = 4;
};

Parameters parameters(TrackedToolParameters& p);
std::string validate(const TrackedToolParameters& p);
// Returns an upper bound, over all poses, of the increase of |force| per displacement of the HIP, N/m.
inline double max_stiffness_N_per_m(const TrackedToolParameters& p) {
  return max_stiffness_N_per_m(p.tool);
}

class TrackedToolRenderer final : public Renderer {
 public:
  // The tool was built with outer_field if contact_rule = continuous.
  TrackedToolRenderer(const TrackedToolParameters& parameters, const std::shared_ptr<const VoxelTool>& tool,
                      const Kernels& kernels);
  void prepare(Frame& frame) const override;
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  void parameters_changed() override { tool_.parameters_changed(); }
  RenderOutput step(const DeviceState& device, double time_s) override;

  const SheetPatches& patches() const { return patches_; }

 private:
  std::shared_ptr<const TiledCloud> shown_points(const ToolPose& pose);
  void requery(const ToolPose& pose, bool held);

  const Kernels& kernels_;
  const double merged_disk_m_;
  const int max_hold_frames_;
  ToolRenderer tool_;
  SheetPatches patches_;
  std::shared_ptr<const TiledCloud> measured_, shown_;  // the measured points, and those that the tool uses
  std::shared_ptr<const TiledCloud> newest_;            // newest points while the surface is missing
  std::shared_ptr<TiledCloud> changed_[2] = {std::make_shared<TiledCloud>(), std::make_shared<TiledCloud>()};
  int present_ = 0;
  double captured_s_ = 0;                                          // time of the newest frame that is shown
  UsualInterval usual_interval_;                                   // interval between such frames
  double hold_until_s_ = std::numeric_limits<double>::infinity();  // finite while the surface is missing
  bool has_frame_ = false;
  bool placed_ = false;  // the tool has started at the device's pose
};

}  // namespace remote_touch
