#include "scenarios/recordings/images_and_clouds/pinhole_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace remote_touch {
namespace {

// An image axis: pixel = focal * ratio + centre, where ratio is x/z or y/z.
struct AxisFit {
  double focal = 0, centre = 0;
  double residual = 0;  // residual of the worst point, pixels
};

// Fits pixel as a linear function of ratio, by least squares over the valid points. In this direction the fit
// minimises residuals in pixels. The sums are taken about the means, so that they keep their digits.
std::optional<AxisFit> fit_axis(const std::vector<double>& ratios, std::size_t columns, bool across) {
  const auto for_valid = [&](auto visit) {
    for (std::size_t first = 0, v = 0; first < ratios.size(); first += columns, ++v) {
      for (std::size_t u = 0; u < columns; ++u) {
        const double ratio = ratios[first + u];
        if (!std::isnan(ratio)) visit(ratio, static_cast<double>(across ? u : v));
      }
    }
  };
  double n = 0, mean_ratio = 0, mean_pixel = 0;
  for_valid([&](double ratio, double pixel) { ++n, mean_ratio += ratio, mean_pixel += pixel; });
  if (n == 0) return std::nullopt;
  mean_ratio /= n, mean_pixel /= n;
  double ratio_2 = 0, ratio_pixel = 0, pixel_2 = 0;
  for_valid([&](double ratio, double pixel) {
    const double r = ratio - mean_ratio, p = pixel - mean_pixel;
    ratio_2 += r * r, ratio_pixel += r * p, pixel_2 += p * p;
  });
  if (ratio_2 <= 0 || pixel_2 < 0.25) return std::nullopt;  // less than two columns (or rows) of pixels
  AxisFit fit{ratio_pixel / ratio_2, 0, 0};
  fit.centre = mean_pixel - fit.focal * mean_ratio;
  for_valid([&](double ratio, double pixel) {
    fit.residual = std::max(fit.residual, std::abs(fit.focal * ratio + fit.centre - pixel));
  });
  return fit;
}

// Computes across / z of each point; NaN for a missing point. Pre: points are in front of the camera.
std::vector<double> ratios(const std::vector<double>& across, const std::vector<double>& z) {
  std::vector<double> result(z.size());
  for (std::size_t i = 0; i < z.size(); ++i) result[i] = across[i] / z[i];
  return result;
}

}  // namespace

void mark_missing_points(PointCloud& cloud) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = cloud.point(i);
    if (p.allFinite() && !p.isZero(0)) continue;
    cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::optional<ImageLayout> fit_pinhole(const PointCloud& cloud, int width, int height) {
  // A pinhole camera sees no point behind it. The fit cannot detect such a point, because x/z is the same at
  // (-x, -z).
  const auto behind_camera = [](double z_m) { return z_m <= 0; };
  if (std::any_of(cloud.z.begin(), cloud.z.end(), behind_camera)) return std::nullopt;
  const std::size_t columns = static_cast<std::size_t>(width);
  const auto u = fit_axis(ratios(cloud.x, cloud.z), columns, true);
  const auto v = fit_axis(ratios(cloud.y, cloud.z), columns, false);
  if (!u || !v || !(u->focal > 0) || !(v->focal > 0)) return std::nullopt;
  const double residual = std::max(u->residual, v->residual);
  if (!(residual < kMaxFitResidual_px)) return std::nullopt;
  const CameraIntrinsics camera{width, height, u->focal, v->focal, u->centre, v->centre};
  return ImageLayout{camera, RigidTransform::Identity(), residual + kPixelRounding_px};
}

}  // namespace remote_touch
