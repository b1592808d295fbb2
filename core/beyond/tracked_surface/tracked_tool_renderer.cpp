#include "core/beyond/tracked_surface/tracked_tool_renderer.h"

#include <cmath>
#include <utility>

#include "core/rendering/frame_order.h"

namespace remote_touch {

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
