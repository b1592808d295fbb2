// Missing points, and intrinsics recovered from an organised cloud, for files that store only the points.
#pragma once

#include <optional>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

inline constexpr double kMaxFitResidual_px = 0.5;  // beyond it a point would belong to another pixel
// Margin for a reader that evaluates the projection in another order of operations.
inline constexpr double kPixelRounding_px = 1e-6;

// Sets all three coordinates of a missing point to NaN. Sensors mark a hole by nan or by the origin.
void mark_missing_points(PointCloud& cloud);

// Returns the pinhole camera that explains a cloud in its camera's frame, in which point v * width + u
// belongs to pixel (u, v): u = fx x/z + cx and v = fy y/z + cy, each fitted by least squares over the valid
// points. pixel_slack is the largest residual plus 1e-6 px. Missing points are NaN. Returns none if a point
// is behind the camera or 0.5 px or more off its pixel, if the image is mirrored, or if the valid points do
// not cover two columns and two rows. Pre: width * height points.
std::optional<ImageLayout> fit_pinhole(const PointCloud& cloud, int width, int height);

}  // namespace remote_touch
