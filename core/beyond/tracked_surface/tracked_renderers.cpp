#include "core/beyond/tracked_surface/tracked_renderers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/rendering/renderer.h"

namespace remote_touch {

namespace {
// The velocity is measured, so it is not estimated, and the radii are fixed, because r_c is the tracker's
// unit of length.
Parameters of_a_sheet(Parameters list) {
  return with_fixed_radii(without(std::move(list), {"velocity_estimate"}));
}
}  // namespace

Parameters parameters(TrackedSheetParameters& p) {
  return appended(of_a_sheet(parameters(p.proxy)), parameters(p.sheet));
}

std::string validate(const TrackedSheetParameters& p) {
  const std::string sheet = validate(p.sheet);
  return sheet.empty() ? validate(p.proxy) : sheet;
}

TrackedSheetRenderer::TrackedSheetRenderer(const TrackedSheetParameters& p, double haptic_rate_hz,
                                           const Kernels& kernels)
    : max_hold_frames_(p.sheet.max_missed_frames),
      proxy_(p.proxy, haptic_rate_hz, kernels),
      tracker_(p.sheet, p.proxy.contact_radius_m(), kernels) {}

Parameters TrackedSheetRenderer::live_parameters() {
  return live_ones(of_a_sheet(proxy_.live_parameters()));
}

void TrackedSheetRenderer::reserve(std::size_t points) {
  proxy_.reserve(points);
  tracker_.reserve(points, true, true);
}

void TrackedSheetRenderer::on_frame(const Frame& frame) {
  if (!proxy_.is_newer(frame)) return proxy_.on_frame(frame);
  const double interval_s = has_frame_ ? frame.captured_s - captured_s_ : 0;
  SheetUpdate update;
  if (placed_)
    update = tracker_.on_frame(frame.points, proxy_position(), interval_s);
  else
    update.points = tracker_.keep(frame.points);
  if (update.points) {
    shown_ = std::move(update.points);
    captured_s_ = frame.captured_s, has_frame_ = true;
    usual_interval_.add(interval_s);
    hold_until_s_ = std::numeric_limits<double>::infinity();
  } else if (std::isinf(hold_until_s_)) {  // the sheet is missing: the shown points stay for a while
    hold_until_s_ = frame.arrives_s + max_hold_frames_ * usual_interval_.without_pause(interval_s);
  }
  proxy_.on_frame({frame.index, frame.captured_s, frame.arrives_s, shown_},
                  {update.displacement_m, update.velocity_m_per_s, update.normal_W});
}

// The proxy has no position until the first finite position of the HIP. A proxy that has moved far needs the
// newest frame's points around its new position.
RenderOutput TrackedSheetRenderer::step(const DeviceState& device, double time_s) {
  if (!placed_ && has_frame_ && device.position_W.allFinite()) {
    placed_ = true;
    show(tracker_.requery({device.position_W, false}));
  } else if (time_s >= hold_until_s_) {
    hold_until_s_ = std::numeric_limits<double>::infinity();
    show(tracker_.reacquire(proxy_.proxy_W()));
  } else if (placed_ && tracker_.must_requery(proxy_.proxy_W())) {
    show(tracker_.requery(proxy_position()));
  }
  proxy_.stop_at_convergence(tracker_.changes_points());
  return proxy_.step(device, time_s);
}

void TrackedSheetRenderer::show(const SheetUpdate& update) {
  if (update.points != shown_) proxy_.replace_points(update.points);
  shown_ = update.points;
  proxy_.displace(update.displacement_m);
}

// The velocity is measured, so it is not estimated.
Parameters parameters(TrackedToolParameters& p) {
  const Parameters own = {
      {"sheet_unit_m", &p.sheet_unit_m, 1e-3, 0.05,
       "unit of length of the sheets, like the contact radius in tracked-sheet; a patch has a radius of 8 units"},
      {"max_patches", &p.max_patches, 1, 16,
       "maximum number of sheet patches: one for each part of the tool, the others for further surfaces in contact"},
  };
  return appended(appended(without(parameters(p.tool), {"velocity_estimate"}), parameters(p.sheet)), own);
}

std::string validate(const TrackedToolParameters& p) {
  const std::string sheet = validate(p.sheet);
  return sheet.empty() ? validate(p.tool) : sheet;
}

TrackedToolRenderer::TrackedToolRenderer(const TrackedToolParameters& p,
                                         const std::shared_ptr<const VoxelTool>& tool, const Kernels& kernels)
    : kernels_(kernels),
      merged_disk_m_(used_merged_disk_m(p.tool)),
      max_hold_frames_(p.sheet.max_missed_frames),
      tool_(p.tool, tool, kernels),
      patches_(p.sheet, p.sheet_unit_m, static_cast<std::size_t>(p.max_patches), *tool, kernels) {}

Parameters TrackedToolRenderer::live_parameters() {
  return live_ones(without(tool_.live_parameters(), {"velocity_estimate"}));
}

void TrackedToolRenderer::prepare(Frame& frame) const {
  frame.prepared = prepared_form<TiledCloud>(*frame.points, kernels_, merged_disk_m_);
}

void TrackedToolRenderer::reserve(std::size_t points) {
  const std::size_t padded = (points / kTilePoints + 1) * kTilePoints;
  tool_.reserve(padded);
  patches_.reserve(points);
  for (auto& cloud : changed_) cloud->reserve(padded);
}

// Returns the measured points, or a cloud in which the points around the tool are denoised.
std::shared_ptr<const TiledCloud> TrackedToolRenderer::shown_points(const ToolPose& pose) {
  if (!patches_.changes_points()) return measured_;
  present_ ^= 1;
  changed_[present_]->assign(*measured_, {pose.p_W, patches_.shown_radius_m()}, patches_);
  return changed_[present_];
}

void TrackedToolRenderer::on_frame(const Frame& frame) {
  if (!tool_.is_newer(frame)) return tool_.on_frame(frame, nullptr, {});
  auto measured = form_of<TiledCloud>(frame, kernels_, merged_disk_m_);
  SheetPatches::Update update;
  ToolPose pose = tool_.pose();
  if (placed_)
    update =
        patches_.on_frame(frame.points, {pose, tool_.is_held(), tool_.near().contacts}, frame.captured_s);
  else
    patches_.keep(frame.points, frame.captured_s);
  if (!update.missing) {
    measured_ = std::move(measured);
    if (!update.motion.displacement.isZero(0)) pose = moved(pose, update.motion.displacement);
    shown_ = placed_ ? shown_points(pose) : measured_;
    if (has_frame_) usual_interval_.add(frame.captured_s - captured_s_);
    captured_s_ = frame.captured_s, has_frame_ = true;
    hold_until_s_ = std::numeric_limits<double>::infinity();
  } else {  // the surface that holds the tool is missing: the shown points stay for a while
    newest_ = std::move(measured);
    if (std::isinf(hold_until_s_))
      hold_until_s_ =
          frame.arrives_s + max_hold_frames_ * usual_interval_.without_pause(frame.captured_s - captured_s_);
  }
  tool_.on_frame(frame, shown_, update.motion);
}

void TrackedToolRenderer::requery(const ToolPose& pose, bool held) {
  const Vector6 out = patches_.requery(pose, held);
  ToolPose there = pose;
  there.p_W += out.head<3>();
  std::shared_ptr<const TiledCloud> points = shown_points(there);
  if (points != shown_) tool_.replace_points(points);
  shown_ = std::move(points);
  if (placed_) tool_.displace(out);
}

// The tool has no position until the first valid pose of the device. A tool that has moved far needs the
// newest frame's points around its new position.
RenderOutput TrackedToolRenderer::step(const DeviceState& device, double time_s) {
  if (has_frame_) {
    if (!placed_) {
      if (const auto goal = device_pose(device)) requery(*goal, false), placed_ = true;
    } else if (time_s >= hold_until_s_) {
      hold_until_s_ = std::numeric_limits<double>::infinity();
      measured_ = std::move(newest_);
      requery(tool_.pose(), false);
    } else if (patches_.must_requery(tool_.pose())) {
      requery(tool_.pose(), tool_.is_held());
    }
  }
  return tool_.step(device, time_s);
}

}  // namespace remote_touch
