#include "core/beyond/tracked_surface/height_fit.h"

#include <algorithm>
#include <limits>
#include <span>

#include "core/points/number_columns.h"

namespace remote_touch {
namespace {

constexpr double kMinNeighbourFraction = 0.25;
constexpr double kMinNeighbours = 2;  // not counting the point itself

constexpr int kTerms = 6, kPlane = 3;  // number of terms; the first kPlane are those of a plane

// Solves a x = b in place by Cholesky's method. Returns false if the matrix is not clearly positive definite.
bool solve(double a[kTerms][kTerms], double b[kTerms]) {
  constexpr double kMinFraction = 1e-4;  // smallest fraction of a diagonal element that may be left
  for (int i = 0; i < kTerms; ++i) {
    const double own = a[i][i];
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i != j)
        a[i][j] = sum / a[j][j];
      else if (sum > kMinFraction * own && own > 0)
        a[i][i] = std::sqrt(sum);
      else
        return false;
    }
  }
  for (int i = 0; i < kTerms; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (int i = kTerms - 1; i >= 0; --i) {
    for (int k = i + 1; k < kTerms; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

// Returns the fraction of the curvature to keep (James and Stein's rule). The improvement of the fit by the
// curvature, in units of the noise's variance, is a chi square of 3 degrees of freedom if there is no
// curvature. No curvature is kept if the improvement is below kOfChance. a: the Cholesky factor.
double fraction_to_keep(const double a[kTerms][kTerms], const double c[kTerms], double sigma) {
  constexpr double kOfChance = 6;
  double improvement = 0;
  for (int j = kPlane; j < kTerms; ++j) {
    double term = 0;
    for (int i = j; i < kTerms; ++i) term += a[i][j] * c[i];
    improvement += term * term;
  }
  return std::max(0.0, 1 - kOfChance * sigma * sigma / std::max(improvement, 1e-12));
}

constexpr int kCells = HeightMap::kCells;
constexpr double kCell = HeightMap::kCell, kHalf = HeightMap::kHalf;

constexpr int kWindows[] = {1, 2, 3, 5, 7, 10};  // half sides, in cells
constexpr double kConfidence = 3;                // half width of an interval, in standard errors
constexpr double kTooUnsure = 0.25;              // a larger standard error does not limit wider windows,
                                                 // contact radii
constexpr double kMinNoise = 0.01;               // smallest noise, for deviations that planes cannot follow
constexpr double kMinWindowPoints = 5;           // minimum number of points in a window

int corner(double coordinate) {
  return static_cast<int>(std::clamp((coordinate + kHalf) / kCell + 0.5, 0.0, kCells + 0.5));
}

}  // namespace

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

Trend fit_trend(const PatchPoints& points, double sigma) {
  constexpr double kMinPoints = 30;
  // The factors are multiples of 2^-12 below 2^6, so sums of up to 2^17 of their products are exact.
  const QuadraticSums sums = points.sums_of_quadratic(kTrendRadius);
  Trend trend;
  if (sums.power[0] < kMinPoints) return trend;
  // Degrees of u and v in each term. Products of the same degree are stored one after the other, in falling
  // powers of u.
  constexpr int of_u[kTerms] = {0, 1, 0, 2, 1, 0}, of_v[kTerms] = {0, 0, 1, 0, 1, 2};
  double a[kTerms][kTerms], b[kTerms];
  for (int i = 0; i < kTerms; ++i) {
    b[i] = sums.with_h[i];
    for (int j = 0; j < kTerms; ++j) {
      const int v = of_v[i] + of_v[j], degree = of_u[i] + of_u[j] + v;
      a[i][j] = sums.power[degree * (degree + 1) / 2 + v];
    }
  }
  if (!solve(a, b)) return trend;
  const double keep = fraction_to_keep(a, b, sigma);
  for (int i = 0; i < kTerms; ++i) trend.c[i] = i < kPlane ? b[i] : keep * b[i];
  return trend;
}

void HeightFit::set_points(const PatchPoints& points, const Trend& trend) {
  trend_ = trend;
  for (Sums& s : sums_) s.fill(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points.is_member(i)) continue;
    const PatchPlace p = points.place(i);
    const int cu = static_cast<int>((p.u + kHalf) / kCell), cv = static_cast<int>((p.v + kHalf) / kCell);
    Sums& s = sums_[static_cast<std::size_t>((cv + 1) * kCorners + cu + 1)];
    const double h = PatchFrame::rounded(p.h - trend.height(p.u, p.v));
    const Sums terms = {1, p.u, p.v, h, p.u * p.u, p.u * p.v, p.v * p.v, p.u * h, p.v * h, h * h};
    for (std::size_t m = 0; m < kMoments; ++m) s[m] += terms[m];
  }
  for (int j = 1; j < kCorners; ++j) {
    Sums row{};
    for (int i = 1; i < kCorners; ++i) {
      Sums& s = sums_[static_cast<std::size_t>(j * kCorners + i)];
      const Sums& under = below(i, j - 1);
      for (std::size_t m = 0; m < kMoments; ++m) row[m] += s[m], s[m] = row[m] + under[m];
    }
  }
  density_ = median_density();
}

HeightFit::Sums HeightFit::window(int cu, int cv, int half) const {
  const int u0 = std::max(0, cu - half), u1 = std::min(kCells, cu + half);
  const int v0 = std::max(0, cv - half), v1 = std::min(kCells, cv + half);
  const Sums &a = below(u1, v1), &b = below(u0, v1), &c = below(u1, v0), &d = below(u0, v0);
  Sums s;
  for (std::size_t m = 0; m < kMoments; ++m) s[m] = a[m] - b[m] - c[m] + d[m];
  return s;
}

double HeightFit::count(int cu, int cv, int half) const {
  const int u0 = std::max(0, cu - half), u1 = std::min(kCells, cu + half);
  const int v0 = std::max(0, cv - half), v1 = std::min(kCells, cv + half);
  return below(u1, v1)[n] - below(u0, v1)[n] - below(u1, v0)[n] + below(u0, v0)[n];
}

PlaneFit HeightFit::plane(const Sums& s, double u, double v) {
  PlaneFit fit;
  fit.count = s[n];
  if (s[n] < 3) return fit;
  const double one = 1 / s[n], mu = s[su] * one, mv = s[sv] * one, mh = s[sh] * one;
  const double cuu = s[uu] - s[su] * mu, cuv = s[uv] - s[su] * mv, cvv = s[vv] - s[sv] * mv;
  const double cuh = s[uh] - s[su] * mh, cvh = s[vh] - s[sv] * mh, chh = s[hh] - s[sh] * mh;
  const double det = cuu * cvv - cuv * cuv;
  if (!(det > 1e-3 * cuu * cvv) || !(cuu > 1e-3) || !(cvv > 1e-3)) return fit;
  const double per = 1 / det, du = u - mu, dv = v - mv;
  fit.slope_u = (cvv * cuh - cuv * cvh) * per;
  fit.slope_v = (cuu * cvh - cuv * cuh) * per;
  fit.height = mh + fit.slope_u * du + fit.slope_v * dv;
  fit.variance = one + (cvv * du * du - 2 * cuv * du * dv + cuu * dv * dv) * per;
  fit.residual = std::max(0.0, chh - fit.slope_u * cuh - fit.slope_v * cvh);
  fit.valid = true;
  return fit;
}

PlaneFit HeightFit::plane_around(double u, double v, double half_side) const {
  return plane(window(corner(u), corner(v), static_cast<int>(std::lround(half_side / kCell))), u, v);
}

double HeightFit::noise() const {
  constexpr double kEnough = 9, kMinOfBlock = 6, kLow = 0.4;
  // The ratio of the variance at that quantile to the mean variance, for a chi square with about 8 degrees of
  // freedom.
  constexpr double kOfMean = 0.85;
  double covered = 0;
  for (int j = 1; j < kCells; j += 2)
    for (int i = 1; i < kCells; i += 2) covered += count(i, j, 1) > 0 ? 1 : 0;
  if (covered == 0) return std::numeric_limits<double>::quiet_NaN();
  const double density = below(kCells, kCells)[n] / covered;
  int half = 1;
  while (half < 4 && density * half * half < kEnough) ++half;
  std::array<double, kCells * kCells / 4> variances;
  std::size_t blocks = 0;
  for (int j = half; j + half <= kCells; j += 2 * half)
    for (int i = half; i + half <= kCells; i += 2 * half) {
      if (count(i, j, half) < kMinOfBlock) continue;
      const PlaneFit fit = plane(window(i, j, half), 0, 0);
      if (fit.valid) variances[blocks++] = fit.residual / (fit.count - 3);
    }
  if (blocks == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(quantile_in_place(std::span(variances).first(blocks), kLow) / kOfMean);
}

double HeightFit::median_density() const {
  std::array<double, HeightMap::kNodes * HeightMap::kNodes> counts;
  std::size_t some = 0;
  for (int j = 0; j <= kCells; j += 2)
    for (int i = 0; i <= kCells; i += 2)
      if (const double c = count(i, j, 2); c > 0) counts[some++] = c;
  if (some == 0) return 0;
  return median_in_place(std::span(counts).first(some)) / 4;
}

void HeightFit::choose(int i, int j, double sigma, HeightMap::Node& node) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  node = {};
  const double u = HeightMap::node_at(i), v = HeightMap::node_at(j);
  double low = -kInfinity, high = kInfinity;
  for (const int half : kWindows) {
    if (count(2 * i, 2 * j, half) < kMinWindowPoints) continue;
    const PlaneFit fit = plane(window(2 * i, 2 * j, half), u, v);
    if (!fit.valid) continue;
    const double error = sigma * std::sqrt(fit.variance);
    if (node.known && error > node.error) continue;  // wider but less certain: beyond the points
    if (node.known && node.error > kTooUnsure) low = -kInfinity, high = kInfinity;
    low = std::max(low, fit.height - kConfidence * error);
    high = std::min(high, fit.height + kConfidence * error);
    if (low > high) break;
    node = {fit.height, fit.slope_u, fit.slope_v, error, true, false};
  }
}

void HeightFit::fit(double sigma, HeightMap& map) const {
  const double typical = 4 * typical_density();
  for (int j = 0; j < HeightMap::kNodes; ++j)
    for (int i = 0; i < HeightMap::kNodes; ++i) {
      HeightMap::Node& node = map.node(i, j);
      if (count(2 * i, 2 * j, 3) < 1) {
        node = {};
        continue;
      }
      choose(i, j, std::max(sigma, kMinNoise), node);
      const double u = HeightMap::node_at(i), v = HeightMap::node_at(j);
      node.height += trend_.height(u, v);
      node.slope_u += trend_.slope_u(u, v), node.slope_v += trend_.slope_v(u, v);
      const double around = count(2 * i, 2 * j, 2);
      node.covered = node.known && around >= 1 && 3 * around >= typical;
    }
  map.fill_cells();
}

}  // namespace remote_touch
