#include "centroid_renderer.h"

#include <cmath>

namespace lab {

using namespace remote_touch;

namespace {

// Returns the mean of the points' own stiffness, in whole steps of 1/1024 N/m. A point without stiffness
// counts as `otherwise`.
double mean_stiffness_N_per_m(const PointsView& points, std::size_t count, double otherwise) {
  if (points.stiffness == nullptr) return otherwise;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += std::round(1024 * (std::isnan(points.stiffness[i]) ? otherwise : points.stiffness[i]));
  return sum / 1024 / static_cast<double>(count);
}

}  // namespace

Parameters parameters(CentroidSettings& settings) {
  return {{"radius_m", &settings.radius_m, 1e-6, 1, "radius r of the ball around the HIP"},
          {"stiffness_N_per_m", &settings.stiffness_N_per_m, 0, 10000, "spring k", kLive}};
}

std::string validate(const CentroidSettings&) {
  return {};
}

CentroidRenderer::CentroidRenderer(const Settings& settings, double, const Kernels& kernels)
    : settings_(settings), kernels_(kernels) {}

void CentroidRenderer::on_frame(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return;
  points_ = frame.points;
  near_.reserve(points_->size(), points_->has_fixture_radius(), points_->has_stiffness());
}

RenderOutput CentroidRenderer::step(const DeviceState& device, double) {
  RenderOutput out;
  out.frame_index = order_.newest();
  out.converged = true;
  if (!device.position_W.allFinite()) {
    out.proxy_W = last_finite_W_;
    out.status = RenderStatus::device_not_finite;
    return out;
  }
  out.proxy_W = last_finite_W_ = device.position_W;
  out.status = order_.status(points_ ? RenderStatus::ok : RenderStatus::no_frame);
  if (!points_) return out;
  near_.clear();
  points_->gather({device.position_W, settings_.radius_m}, kernels_, near_);
  out.contact_count = static_cast<int>(near_.size());
  if (near_.size() == 0) return out;
  const PointsView points = near_.view();
  // A sum of whole numbers does not depend on the order of the points, which is the order of the search.
  const double grid_m = 0x1p-26 * settings_.radius_m;
  Vec3 sum = Vec3::Zero();  // sum of the points relative to the HIP, in units of the grid
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const Vec3 offset_m = Vec3(points.x[i], points.y[i], points.z[i]) - device.position_W;
    sum += Vec3((offset_m / grid_m).array().round());
  }
  const Vec3 from_centroid_m = -grid_m / static_cast<double>(near_.size()) * sum;
  const double distance_m = from_centroid_m.norm();
  if (distance_m == 0) return out;
  out.nearest_distance_m = distance_m;
  out.normal_W = from_centroid_m / distance_m;
  const double stiffness_N_per_m = mean_stiffness_N_per_m(points, near_.size(), settings_.stiffness_N_per_m);
  out.force_N = stiffness_N_per_m * (settings_.radius_m - distance_m) * out.normal_W;
  out.state = ContactState::contact;
  return out;
}

}  // namespace lab
