#include "core/points/neighbourhood.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/kernels/proxy_kernels.h"

namespace remote_touch {

namespace {
// The edge of a cube in units of the reach. A smaller edge means fewer useless points in a list, a larger one
// means fewer new lists.
constexpr double kPitch = 0.125;
// The distance that a proxy may move with a narrow list, in units of the reach, and the longest step of a
// slow proxy, in units of that distance. Each step of 4.2.4 is 1 - gamma times the one before, so a slow
// proxy often stays near.
constexpr double kNarrowMargin = 0.02, kSlow = 0.3;
// The maximum number of hops in which a tube is searched, however far the HIP jumped.
constexpr double kMaxHops = 64;
}  // namespace

Neighbourhood::Neighbourhood(double reach, const Kernels& kernels) : kernels_(kernels) {
  set_reach(reach);
}

void Neighbourhood::set_reach(double reach) {
  reach_ = reach;
  pitch_ = kPitch * reach;
  list_radius_ = reach_ + 0.8661 * pitch_;  // sqrt(3)/2, from a cube's centre to its corner, rounded up
  narrow_margin_ = kNarrowMargin * reach;
  forget_lists();
}

void Neighbourhood::forget_lists() {
  for (CachedList& kept : cache_) kept.valid = false;
  narrow_.valid = false;
}

void Neighbourhood::set_points(std::shared_ptr<const NeighbourSearch> points) {
  points_ = std::move(points);
  reserve(points_->size(), points_->has_fixture_radius(), points_->has_stiffness());
  forget_lists();
}

void Neighbourhood::reserve(std::size_t points, bool with_radius, bool with_stiffness) {
  for (CachedList& kept : cache_) kept.points.reserve(points, with_radius, with_stiffness);
  tube_.reserve(points, with_radius, with_stiffness);
  narrow_.points.reserve(points, with_radius, with_stiffness);
}

const GatheredPoints& Neighbourhood::around(const Vec3& p) {
  // Most positions lie well inside the present cube. The slow test decides near its border.
  const CachedList& present = cache_[current_];
  if (present.valid && ((p - present.centre).array().abs() < 0.499 * pitch_).all()) return present.points;
  const Vec3 centre = (p / pitch_).array().round().matrix() * pitch_;
  const auto holds = [&](const CachedList& kept) { return kept.valid && centre == kept.centre; };
  for (std::size_t i = 0; i < cache_.size(); ++i)
    if (holds(cache_[i])) return cache_[current_ = i].points;
  current_ = (current_ + 1) % cache_.size();
  cache_[current_].centre = centre;
  gather(cache_[current_]);
  return cache_[current_].points;
}

void Neighbourhood::gather(CachedList& kept) {
  kept.points.clear();
  points_->gather({kept.centre, list_radius_}, kernels_, kept.points);
  kept.points.finish();
  kept.sum_grid = 1.5 * static_cast<double>(std::bit_ceil(kept.points.size() + 1));
  kept.valid = true;
  narrow_.valid = false;
}

const GatheredPoints& Neighbourhood::narrowed(const Vec3& p) {
  const GatheredPoints& wide = around(p);
  const auto is_near = [&](const Vec3& q, double distance) {
    return (p - q).squaredNorm() < distance * distance;
  };
  const bool is_slow = is_near(std::exchange(last_W_, p), kSlow * narrow_margin_);
  // The narrow list of one cube is not used in the next: it was made from a list that may lack points within
  // the reach of a position there.
  if (narrow_.valid && narrow_of_ == current_ && is_near(narrow_.centre, narrow_margin_))
    return narrow_.points;
  if (!is_slow) return wide;
  narrow_.centre = p;
  narrow_.valid = true, narrow_of_ = current_;
  narrow_.points.clear();
  narrow_.points.add(wide.run(), {p, (reach_ + narrow_margin_) * (1 + 1e-9)}, kernels_);
  narrow_.points.finish();
  return narrow_.points;
}

const GatheredPoints& Neighbourhood::within(const Vec3& p, double radius) {
  tube_.clear();
  points_->gather({p, radius * (1 + 1e-9)}, kernels_, tube_);
  tube_.finish();
  return tube_;
}

double Neighbourhood::first_hit(const Vec3& p, const Vec3& u, double radius, double limit,
                                bool with_regions) {
  const auto hit_in = [&](const GatheredPoints& gathered) {
    PointsView points = gathered.view();
    if (!with_regions) points.radius = nullptr;
    return kernels_.proxy.first_hit(points, p.data(), u.data(), radius);
  };
  // The present list holds every point that can be met before `known`: its region meets the ball around p
  // that contains the swept tube up to there.
  if (const CachedList& here = cache_[current_]; here.valid) {
    const double known = list_radius_ * (1 - 1e-9) - (p - here.centre).norm() - radius;
    const double hit = known > 0 ? std::min(limit, hit_in(here.points)) : limit;
    if (hit <= known) return hit;
  }

  // A point whose region is met first between two hops lies within radius (plus r_f) of that part of the
  // axis, so it meets the ball of that hop. The root is computed from p itself for every hop, so the result
  // does not depend on the hops.
  const double hop = std::max(2 * reach_, limit / kMaxHops);
  for (double start = 0; start < limit; start += hop) {
    const double end = std::min(start + hop, limit);
    const double rounding = 1e-9 * (1 + end);
    tube_.clear();
    points_->gather({p + 0.5 * (start + end) * u, 0.5 * (end - start) + radius + rounding}, kernels_, tube_);
    tube_.finish();
    const double hit = hit_in(tube_);
    if (hit <= end) return hit;
  }
  return limit;
}

}  // namespace remote_touch
