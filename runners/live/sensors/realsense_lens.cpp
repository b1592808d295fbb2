#include "runners/live/sensors/realsense_lens.h"

#include <algorithm>
#include <cmath>

#include "core/parameters/input_error.h"

namespace remote_touch::rs2 {

bool has_distortion(const Intrinsics& intrinsics) {
  return intrinsics.model != distortion_none &&
         std::any_of(std::begin(intrinsics.coefficients), std::end(intrinsics.coefficients),
                     [](float coefficient) { return coefficient != 0; });
}

Lens lens_of(const std::string& name, const RealSenseLibrary& rs2, const Intrinsics& intrinsics) {
  if (rs2.project_point_to_pixel == nullptr || rs2.deproject_pixel_to_point == nullptr)
    throw InputError(name,
                     "has a lens with distortion: expected librealsense 2.46 or newer, which can compute it");
  if (intrinsics.model != brown_conrady && intrinsics.model != inverse_brown_conrady)
    throw InputError(name, "has a lens of model " + std::to_string(intrinsics.model) +
                               ": expected one of Brown and Conrady, whose pixels have known rays");
  using Eigen::Vector2d;
  const auto finite = [](double x, double y) -> std::optional<Vector2d> {
    if (!std::isfinite(x) || !std::isfinite(y)) return {};
    return Vector2d(x, y);
  };
  return {[=, &rs2](const Vector2d& ray) {
            const float point[3] = {static_cast<float>(ray.x()), static_cast<float>(ray.y()), 1};
            float pixel[2] = {NAN, NAN};
            rs2.project_point_to_pixel(pixel, &intrinsics, point);
            return finite(pixel[0], pixel[1]);
          },
          [=, &rs2](const Vector2d& at) {
            const float pixel[2] = {static_cast<float>(at.x()), static_cast<float>(at.y())};
            float point[3] = {NAN, NAN, NAN};
            rs2.deproject_pixel_to_point(point, &intrinsics, pixel, 1);
            return finite(point[0], point[1]);
          }};
}

}  // namespace remote_touch::rs2
