#include "core/beyond/tracked_surface/tracked_sheet_renderer.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace remote_touch
