#include "core/rivals/point_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace remote_touch {
namespace {

// The number of sweeps. Each sweep squares the rest of the off-diagonal elements, so four or five are enough.
constexpr int kSweeps = 8;
// An element smaller than this fraction of the trace counts as zero.
constexpr double kNothing = 1e-20;

// Rotates in the plane of the axes p and q so that a(p, q) vanishes (Golub and Van Loan, 8.5.2). Returns
// false if a(p, q) is zero already.
bool rotate(Eigen::Matrix3d& a, Eigen::Matrix3d& axes, int p, int q, double nothing) {
  if (std::abs(a(p, q)) <= nothing) return false;
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const int r = 3 - p - q;
  const double pr = a(p, r), qr = a(q, r);
  a(p, p) -= t * a(p, q), a(q, q) += t * a(p, q);
  a(p, q) = a(q, p) = 0;
  a(p, r) = a(r, p) = c * pr - s * qr;
  a(q, r) = a(r, q) = s * pr + c * qr;
  for (int i = 0; i < 3; ++i) {
    const double vp = axes(i, p), vq = axes(i, q);
    axes(i, p) = c * vp - s * vq, axes(i, q) = s * vp + c * vq;
  }
  return true;
}

constexpr double kMaxRadius_m = 0.5;
// The factor covers rounding, by which squares of equal distances differ.
constexpr double kSameDistance = 1 + 1e-9;
constexpr int kNeighbours = 3;
constexpr std::size_t kMaxSample = 20000;  // more points would delay the tick in which a frame arrives

// Returns true for about one of `stride` points. The choice depends on the position alone, so that the order
// of the points has no effect.
bool is_sampled(const Vec3& p, std::size_t stride) {
  constexpr std::uint64_t kMix = 0xbf58476d1ce4e5b9;  // the multiplier of splitmix64
  std::uint64_t bits = 0;
  for (const double x : p) bits = (bits ^ std::bit_cast<std::uint64_t>(x)) * kMix, bits ^= bits >> 31;
  return bits % stride == 0;
}

// If the middle variance is below this, in units of the squared distance of the last neighbour, there is no
// plane.
constexpr double kMinPlaneWidth = 1e-6;

// A gradient shorter than this has no direction, because it is only rounding.
constexpr double kNoDirection = 1e-10;
// Smaller sums of weights are mostly rounding: the position counts as outside of all support.
constexpr double kMinWeight = 1e-6;
// If the middle variance is below this, in units of R^2, the points do not span a plane.
constexpr double kMinWidth = 1e-6;
// An upper bound of the length of a term of the gradient, with which the terms are scaled to magnitude 1.
constexpr double kMaxTerm = 4;

// weight: w at a distance; slope: the factor of (x - p) / R in the gradient of w with respect to p / R.
struct Bell {
  double weight, slope;
};

// The polynomial is factored, so that rounding near the rim makes no weight negative.
Bell wyvill(double squared) {
  const double rest = 1 - squared;
  return {rest * rest * (1 - squared * (4.0 / 9)), 2 * rest * (22.0 / 9 - squared * (12.0 / 9))};
}

Bell wendland(double squared) {
  const double q = std::sqrt(squared), rest = 1 - q, cubed = rest * rest * rest;
  return {cubed * rest * (4 * q + 1), 20 * cubed};
}

// Calls act(bell, e, i) for every point i within R, e = (x - p) / R.
template <class Act>
void for_each_near(const PointsView& points, const Vec3& p_W, double radius_m, SurfaceWeight weight,
                   const Act& act) {
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 e = (Vec3(points.x[i], points.y[i], points.z[i]) - p_W) / radius_m;
    const double squared = e.squaredNorm();
    if (!(squared < 1)) continue;
    act(weight == SurfaceWeight::wyvill ? wyvill(squared) : wendland(squared), e, i);
  }
}

}  // namespace

ThinnestAxis thinnest_axis(const Eigen::Matrix3d& symmetric) {
  Eigen::Matrix3d a = symmetric, axes = Eigen::Matrix3d::Identity();
  const double nothing = kNothing * std::abs(a.trace());
  bool turned = true;
  for (int sweep = 0; turned && sweep < kSweeps; ++sweep) {
    turned = rotate(a, axes, 0, 1, nothing);
    turned |= rotate(a, axes, 0, 2, nothing);
    turned |= rotate(a, axes, 1, 2, nothing);
  }
  int min = 0;
  for (int i = 1; i < 3; ++i)
    if (a(i, i) < a(min, min)) min = i;
  const double others[] = {a((min + 1) % 3, (min + 1) % 3), a((min + 2) % 3, (min + 2) % 3)};
  return {axes.col(min), a(min, min), std::min(others[0], others[1])};
}

void NearestPoints::reserve(std::size_t points) {
  near_.reserve(points, true, true);
  squared_.grow(points), sorted_.grow(points);
}

Vec3 NearestPoints::offset(std::size_t i) const {
  const PointsView view = near_.view();
  return Vec3(view.x[i], view.y[i], view.z[i]) - p_W_;
}

// Gathers the points in a ball around p_W_. Returns the number of points in the ball. The list also has the
// points outside whose regions reach into it.
std::size_t NearestPoints::gather(const NeighbourSearch& points, double radius) {
  near_.clear();
  points.gather({p_W_, radius}, kernels_, near_);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    sorted_[i] = squared_[i] = offset(i).squaredNorm();
    if (squared_[i] <= radius * radius) ++inside;
  }
  return inside;
}

// A ball that holds enough points contains the nearest ones, however large it is: the radius affects the time
// only.
double NearestPoints::find(const NeighbourSearch& points, const Vec3& p_W, int count) {
  reserve(points.size());
  p_W_ = p_W;
  const auto wanted = static_cast<std::size_t>(count);
  double radius = radius_m_;
  std::size_t inside = gather(points, radius);
  while (inside < wanted && radius < kMaxRadius_m) {
    radius = std::min(2 * radius, kMaxRadius_m);
    inside = gather(points, radius);
  }
  if (inside == 0) return limit_ = 0;
  const std::size_t last = std::min(wanted, inside);
  std::nth_element(sorted_.data(), sorted_.data() + (last - 1), sorted_.data() + near_.size());
  limit_ = sorted_[last - 1] * kSameDistance;
  const double distance = std::sqrt(sorted_[last - 1]);
  if (inside >= wanted && distance > 0) radius_m_ = std::min(1.5 * distance, kMaxRadius_m);
  return distance;
}

// The sum is in whole nanometres, so that the order of the terms has no effect.
double mean_spacing_m(const NeighbourSearch& points, NearestPoints& nearest, const Kernels& kernels,
                      PointCloud& buffer) {
  constexpr double kUnit_m = 1e-9;
  const PointCloud& cloud = points.every_point(kernels, buffer);
  const std::size_t stride = cloud.size() / kMaxSample + 1;
  std::int64_t sum = 0, terms = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i) || !is_sampled(cloud.point(i), stride)) continue;
    const double farthest = nearest.find(points, cloud.point(i), kNeighbours + 1);
    if (!(farthest > 0)) continue;
    double distances = 0;
    int others = 0;
    nearest.for_each([&](const Vec3& e) { distances += std::round(e.norm() / kUnit_m), ++others; });
    if (others <= kNeighbours) continue;
    // If several points are at the last distance, only as many count as make three in all.
    distances -= (others - 1 - kNeighbours) * std::round(farthest / kUnit_m);
    sum += static_cast<std::int64_t>(distances), terms += kNeighbours;
  }
  return terms > 0 ? kUnit_m * static_cast<double>(sum) / static_cast<double>(terms) : 0;
}

ViewPoint view_point(const NeighbourSearch& points, const Vec3& direction_W) {
  ViewPoint view;
  view.direction_W = direction_W;
  if (const PointCloud* const stored = points.stored_cloud(); stored && stored->image) {
    view.has_position = true;
    view.position_W = stored->image->X_WC.translation();
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

Vec3 SurfaceSample::normal() const {
  const double length = gradient.norm();
  return length > kNoDirection ? Vec3(gradient / length) : Vec3::Zero();
}

double SurfaceSample::distance() const {
  const double length = gradient.norm();
  return length > kNoDirection ? value / length : std::copysign(1.0, value);
}

SurfaceSample PointSurface::at(const PointsView& points, double sum_grid, const Vec3& p_W,
                               const Vec3& side) const {
  return kind_ == SurfaceKind::metaballs ? metaballs(points, sum_grid, p_W)
                                         : surfels(points, sum_grid, p_W, side);
}

SurfaceSample PointSurface::metaballs(const PointsView& points, double sum_grid, const Vec3& p_W) const {
  ExactSum weights(sum_grid);
  ExactVector slopes(sum_grid);
  for_each_near(points, p_W, radius_m_, weight_, [&](const Bell& bell, const Vec3& e, std::size_t) {
    weights.add(bell.weight);
    slopes.add((bell.slope / kMaxTerm) * e);
  });
  if (!(weights.value() > 0)) return {};
  return {true, threshold_ - weights.value(), -kMaxTerm * slopes.value()};
}

SurfaceSample PointSurface::surfels(const PointsView& points, double sum_grid, const Vec3& p_W,
                                    const Vec3& side) const {
  ExactMoments moments(sum_grid);
  for_each_near(points, p_W, radius_m_, weight_,
                [&](const Bell& bell, const Vec3& e, std::size_t) { moments.add(bell.weight, e); });
  if (!(moments.weight() > kMinWeight)) return {};
  const Vec3 mean = moments.mean();  // a - p
  const ThinnestAxis thin = thinnest_axis(moments.covariance());
  if (thin.middle < kMinWidth) {
    const double length = mean.norm();
    return {true, length, length > kNoDirection ? Vec3(-mean / length) : Vec3::Zero()};
  }
  const double ahead = side.isZero(0) ? -thin.axis.dot(mean) : thin.axis.dot(side);
  const Vec3 n = ahead < 0 ? Vec3(-thin.axis) : thin.axis;
  return {true, -n.dot(mean), n};
}

SurfaceSample PointSurface::oriented(const PointsView& points, const Vec3* normals, double sum_grid,
                                     const Vec3& p_W) const {
  ExactSum weights(sum_grid);
  ExactVector first(sum_grid), directions(sum_grid);
  for_each_near(points, p_W, radius_m_, weight_, [&](const Bell& bell, const Vec3& e, std::size_t i) {
    weights.add(bell.weight);
    first.add(bell.weight * e);
    directions.add(bell.weight * normals[i]);
  });
  if (!(weights.value() > kMinWeight)) return {};
  const Vec3 mean = first.value() / weights.value(), sum = directions.value();  // a - p
  const double length = sum.norm();
  if (!(length > kMinWeight)) return {};
  const Vec3 n = sum / length;
  return {true, -n.dot(mean), n};
}

}  // namespace remote_touch
