// A cloud in the form that renderers read: a tree, or tiles.
#pragma once

#include <memory>

#include "core/points/point_cloud.h"

namespace remote_touch {

template <class Form, class... Settings>
std::shared_ptr<const Form> in_form(const PointCloud& cloud, const Settings&... settings) {
  const auto form = std::make_shared<Form>();
  form->assign(cloud, settings...);
  return form;
}

}  // namespace remote_touch
