#include "core/beyond/tracked_surface/patch_points.h"

#include <algorithm>

namespace remote_touch {

bool PatchRegion::holds(const Ball& ball) const {
  const PatchPlace p = frame.place(ball.centre);
  const double reach = ball.radius / frame.unit_m() + 0x1p-10;
  return std::hypot(p.u, p.v) + reach < radius && std::abs(p.h) + reach < half_height;
}

void PatchPoints::reserve(std::size_t points) {
  const std::size_t capacity = points + kLanes;  // the kernels also process the padding of the points
  for (Buffer<double>* column : {&u_, &v_, &h_, &residual_}) column->grow(capacity);
  source_.grow(capacity), member_.grow(capacity), bin_.grow(capacity);
}

void PatchPoints::set_points(const GatheredPoints& gathered, const PatchRegion& region) {
  PatchAxes axes{};
  const PatchFrame& frame = region.frame;
  for (int k = 0; k < 3; ++k) {
    axes.origin[k] = frame.origin_W()[k];
    axes.u[k] = frame.u_W()[k], axes.v[k] = frame.v_W()[k], axes.n[k] = frame.normal_W()[k];
  }
  axes.unit_m = frame.unit_m(), axes.radius = region.radius, axes.half_height = region.half_height;
  count_ = kernels_.patch.points_of_patch(gathered.view(), axes, columns());
  std::fill_n(member_.data(), count_, std::uint8_t{0});
}

void PatchPoints::add(const PatchPlace& place, bool is_member) {
  u_[count_] = place.u, v_[count_] = place.v, h_[count_] = place.h;
  member_[count_++] = is_member;
}

void PatchPoints::set_residuals(const HeightMap& map) {
  kernels_.patch.heights_above(columns(), count_, map.grid(), residual_.data());
}

HeightProfile PatchPoints::profile_near(const PatchPlace& place, double reach, double half_range) const {
  HeightProfile profile(half_range);
  const HeightBins bins{profile.half_range(), HeightProfile::kBin, profile.bins()};
  kernels_.patch.height_bins(columns(), count_, residual_.data(), place.u, place.v, reach, bins, bin_.data());
  profile.add_bins(bin_.data(), count_);
  return profile;
}

PlaneSums PatchPoints::sums_near(const NearPlane& plane) const {
  return kernels_.patch.sums_near_plane(columns(), count_, residual_.data(), plane);
}

QuadraticSums PatchPoints::sums_of_quadratic(double radius) const {
  return kernels_.patch.sums_of_quadratic(columns(), member_.data(), count_, radius);
}

namespace {

constexpr double kMinNeighbourFraction = 0.25;
constexpr double kMinNeighbours = 2;  // not counting the point itself

}  // namespace

// Returns the index of a column. Columns are one contact radius wide, with an empty one as a border on either
// side.
int StrayPoints::column(double coordinate) const {
  return 1 + static_cast<int>(std::clamp(coordinate + half_side_, 0.0, side_ - 3.0));
}

int StrayPoints::layer(double height) const {
  return 1 + static_cast<int>(std::clamp((height + half_height_) / thickness_, 0.0, layers_ - 3.0));
}

void StrayPoints::count(const PatchPoints& points, const PatchRegion& region, double sigma,
                        double per_unit_area) {
  half_side_ = region.radius, half_height_ = region.half_height;
  side_ = static_cast<int>(std::ceil(2 * half_side_)) + 2;
  thickness_ = std::max({0.5, sigma, 2 * half_height_ / 127});
  layers_ = static_cast<int>(std::ceil(2 * half_height_ / thickness_)) + 2;
  min_ = std::max(kMinNeighbours + 1, kMinNeighbourFraction * 9 * per_unit_area);
  std::fill_n(counts_.begin(), side_ * side_ * layers_, std::uint16_t{0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.is_member(i)) continue;
    const PatchPlace p = points.place(i);
    std::uint16_t& c =
        counts_[static_cast<std::size_t>((layer(p.h) * side_ + column(p.v)) * side_ + column(p.u))];
    if (c < 60000) ++c;
  }
}

bool StrayPoints::is_surface(const PatchPlace& p) const {
  double sum = 0;
  for (int l = layer(p.h) - 1; l <= layer(p.h) + 1; ++l)
    for (int v = column(p.v) - 1; v <= column(p.v) + 1; ++v)
      for (int u = column(p.u) - 1; u <= column(p.u) + 1; ++u)
        sum += counts_[static_cast<std::size_t>((l * side_ + v) * side_ + u)];
  return sum >= min_;
}

}  // namespace remote_touch
