#include "core/rivals/nearest_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace remote_touch {

namespace {

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

}  // namespace

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

}  // namespace remote_touch
