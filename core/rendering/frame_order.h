// The newest frame of a stream. A frame that was captured no later than the newest one is dropped, and the
// drop is reported once.
#pragma once

#include <memory>
#include <utility>

#include "core/kernels/kernels.h"
#include "core/points/neighbour_search.h"
#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

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
// per frame, in advance by prepare() or in on_frame().

// Form: any class with assign(const PointCloud&, settings...).
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

}  // namespace remote_touch
