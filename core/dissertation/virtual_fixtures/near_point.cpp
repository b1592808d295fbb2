#include "core/dissertation/virtual_fixtures/near_point.h"

#include <limits>

#include "core/parameters/input_error.h"

namespace remote_touch {

Parameters parameters(NearPoint::Settings& s) {
  const Parameters own = {
      {"point_m", &s.point_m, -100, 100, "centre of the selection, world frame"},
      {"row", &s.row, -1, 4095, "image row of the centre of the selection; -1: use point_m"},
      {"column", &s.column, -1, 4095, "image column of the centre; -1: use point_m"},
      {"inner_radius_m", &s.inner_radius_m, 0, 100,
       "points within this distance of the centre have weight 1"},
      {"falloff_m", &s.falloff_m, 0, 100,
       "beyond inner_radius_m the weight falls linearly to 0 over this distance"},
  };
  return appended(parameters(s.values), own);
}

std::string validate(const NearPoint::Settings& s) {
  if ((s.row < 0) != (s.column < 0)) return "row and column: expected both 0 or more, or both -1";
  return validate(s.values);
}

namespace {

// Returns the point of the pixel that is nearest to (u, v) among those with a depth; NaN if there is none.
Vec3 nearest_measured(const PointCloud& cloud, const CameraIntrinsics& camera, int u, int v) {
  const auto seen = [&](int x, int y) { return cloud.point(static_cast<std::size_t>(y) * camera.width + x); };
  if (seen(u, v).allFinite()) return seen(u, v);
  Vec3 nearest = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  long long min = std::numeric_limits<long long>::max();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const long long dx = x - u, dy = y - v, squared = dx * dx + dy * dy;
      if (squared < min && seen(x, y).allFinite()) nearest = seen(x, y), min = squared;
    }
  }
  return nearest;
}

}  // namespace

void NearPoint::require(const PointCloud& cloud) const {
  if (settings_.row < 0) return;
  if (!cloud.image)
    throw InputError("near-point: row, column",
                     "the frame is not an image: expected a scenario with a camera");
  const CameraIntrinsics& camera = cloud.image->camera;
  if (settings_.row >= camera.height || settings_.column >= camera.width)
    throw InputError("near-point: row, column", "expected below " + std::to_string(camera.height) + " and " +
                                                    std::to_string(camera.width));
}

Vec3 NearPoint::picked(const PointCloud& cloud) const {
  require(cloud);
  if (settings_.row < 0) return settings_.point_m;
  return nearest_measured(cloud, cloud.image->camera, settings_.column, settings_.row);
}

std::vector<double> NearPoint::weights(const PointCloud& cloud) const {
  const Vec3 centre = picked(cloud);
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double beyond = (cloud.point(i) - centre).norm() - settings_.inner_radius_m;
    if (beyond <= 0)
      weights[i] = 1;
    else if (beyond < settings_.falloff_m)
      weights[i] = 1 - beyond / settings_.falloff_m;
  }
  return weights;
}

}  // namespace remote_touch
