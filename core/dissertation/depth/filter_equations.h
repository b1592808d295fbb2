// The bilateral filter of a depth image, (7.1) and (7.2), one statement each. The kernel of
// core/kernels/depth_kernels.h filters many pixels at a time and is tested against this form.
#pragma once

#include <cmath>
#include <span>

#include "core/points/vector.h"

namespace remote_touch::equations {

// The weight phi of a point in the filter of the point p0, (7.2). Lengths are in m.
inline double filter_weight(const Vec3& p, const Vec3& p0, double sigma_f_m) {
  return std::exp(-(p - p0).squaredNorm() / (2 * sigma_f_m * sigma_f_m));  // (7.2)
}

// The filtered depth of the point p0, (7.1). window: the points of the pixels around it and its own, camera
// frame.
inline double filtered_depth(std::span<const Vec3> window, const Vec3& p0, double sigma_f_m) {
  double sum = 0, total = 0;
  for (const Vec3& p : window)
    sum += filter_weight(p, p0, sigma_f_m) * p.z(), total += filter_weight(p, p0, sigma_f_m);
  return sum / total;  // (7.1)
}

}  // namespace remote_touch::equations
