// The data structure that a renderer reads in place of a cloud's columns, such as a tree. It is built once a
// frame, in advance by prepare() or in on_frame().
#pragma once

#include <memory>

#include "core/kernels/kernels.h"
#include "core/rendering/frame.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

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
