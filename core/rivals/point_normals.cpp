#include "core/rivals/point_normals.h"

#include "core/rivals/exact_sum.h"
#include "core/rivals/thinnest_axis.h"

namespace remote_touch {

namespace {

// If the middle variance is below this, in units of the squared distance of the last neighbour, there is no
// plane.
constexpr double kMinPlaneWidth = 1e-6;

}  // namespace

ViewPoint view_point(const NeighbourSearch& points, const Vec3& direction_W) {
  ViewPoint view;
  view.direction_W = direction_W;
  const auto* stored = dynamic_cast<const CloudSearch*>(&points);
  if (stored && stored->cloud().image) {
    view.has_position = true;
    view.position_W = stored->cloud().image->X_WC.translation();
  }
  return view;
}

void PointNormals::reserve(std::size_t points) {
  nearest_.reserve(points);
  if (normals_.size() < points) normals_.resize(points), computed_in_.resize(points);
}

void PointNormals::set_points(const NeighbourSearch& points, const ViewPoint& view) {
  reserve(points.size());
  points_ = &points;
  view_ = view;
  ++frame_;
}

Vec3 PointNormals::of(std::uint32_t number, const Vec3& x_W) {
  if (computed_in_[number] != frame_) {
    computed_in_[number] = frame_;
    normals_[number] = compute(x_W);
  }
  return normals_[number];
}

Vec3 PointNormals::compute(const Vec3& x_W) {
  const double farthest = nearest_.find(*points_, x_W, neighbours_);
  if (!(farthest > 0)) return Vec3::Zero();
  std::size_t count = 0;
  nearest_.for_each([&](const Vec3&) { ++count; });
  // Neighbours at the last distance may be slightly farther away than 1.
  ExactMoments moments(2 * sum_grid_for(count));
  nearest_.for_each([&](const Vec3& e) { moments.add(1, e / farthest); });
  const ThinnestAxis thin = thinnest_axis(moments.covariance());
  if (thin.middle < kMinPlaneWidth) return Vec3::Zero();
  return thin.axis.dot(view_.ray_to(x_W)) > 0 ? Vec3(-thin.axis) : thin.axis;
}

}  // namespace remote_touch
